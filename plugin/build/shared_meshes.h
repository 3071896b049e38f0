// SPDX-License-Identifier: Apache-2.0
// Which meshes of a soup lie in several places, so that they are cut and packed once, where they
// are by themselves, and placed by portals.
#pragma once

#include "core/soup.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// The chunks of a soup, by their numbers.
struct Placed {
    /// Chunks of the same mesh that lie exactly in the same place.
    struct Copies {
        uint32_t first;
        uint32_t second; // the next smallest
        uint32_t count;  // all of them; those but the first are left out
    };
    /// The chunks of one mesh, each in a place of its own.
    using Instances = std::vector<uint32_t>;

    std::vector<uint32_t> once;    // their triangles are cut together
    std::vector<Instances> shared; // by their first
    std::vector<Copies> copies;    // by first
};

/// Shares what is placed more than once where that saves more than portals cost, and where a portal
/// is as good as the triangles themselves.
Placed placed_chunks(const Soup& soup);

/// The triangles that are packed: once for each mesh that is shared.
uint64_t unique_triangles(const Soup& soup, const Placed& placed);

} // namespace ovc
