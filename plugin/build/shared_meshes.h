// SPDX-License-Identifier: Apache-2.0
// Finds the meshes of a soup that lie in several places. Each is cut and packed once, where it lies
// without a transform, and portals lead to its places.
#pragma once

#include "core/soup.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace ovc {

/// The chunks of a soup, which are named by their numbers, and how each is built.
struct Placed {
    /// Chunks of the same mesh that lie exactly in the same place: sorted, at least two. Only the
    /// first is built.
    using Copies = std::vector<uint32_t>;
    /// The chunks of one mesh, each in a place of its own.
    using Instances = std::vector<uint32_t>; // sorted

    std::vector<uint32_t> once;    // sorted; their triangles are cut together
    std::vector<Instances> shared; // in the order of their meshes
    std::vector<Box> boxes;        // of the triangles of each of them, not placed
    std::vector<Copies> copies;    // sorted
};

/// Returns how the chunks of a soup are built. A mesh that is placed more than once is shared where
/// that saves more than portals cost, and where a portal is as good as the triangles themselves. A
/// chunk that moves is shared even if it is the only one of its mesh.
/// known_box(chunk): the box of the chunk's triangles before they are placed; nothing where it is
/// to be found here.
using KnownBox = std::function<std::optional<Box>(uint32_t chunk)>;
Placed placed_chunks(const Soup& soup, const KnownBox& known_box = {});

/// Returns the number of triangles that are packed: those of a shared mesh count once.
uint64_t unique_triangles(const Soup& soup, const Placed& placed);

} // namespace ovc
