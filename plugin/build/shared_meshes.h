// SPDX-License-Identifier: Apache-2.0
// Finds the meshes of a soup that lie in several places. Each is cut and packed once, where it lies
// without a transform, and portals lead to its places. Meshes that lie together in every place, as
// the shapes of an object do, are shared together: a ray goes through one portal to them all.
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
    /// Some meshes that are shared together. Their chunks in a place follow each other.
    struct Shared {
        std::vector<uint32_t> places; // the first chunk of each, sorted
        uint32_t chunks = 1;          // in each place
        Box box;                      // of the triangles, not placed

        /// Calls visit(chunk) for each chunk of all places.
        template <class Visit>
        void for_each_chunk(Visit&& visit) const {
            for (const uint32_t place : places)
                for (uint32_t i = 0; i < chunks; ++i)
                    visit(place + i);
        }
    };

    std::vector<uint32_t> once; // sorted; their triangles are cut together
    std::vector<Shared> shared; // in the order of their meshes
    std::vector<Copies> copies; // sorted
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
