// SPDX-License-Identifier: Apache-2.0
// Changes: what has changed in a soup since a structure over it was built.
#pragma once

#include <cstdint>
#include <vector>

namespace ovc {

/// Triangles [first, end) of a mesh.
struct PrimRange {
    uint32_t mesh;
    uint32_t first;
    uint32_t end;

    auto operator<=>(const PrimRange&) const = default;
};

/// Chunks are named by their numbers in the soup. One that is removed is empty afterwards, and its
/// number stays its own; those that are added come behind all others.
struct Changes {
    std::vector<PrimRange> moved;   // triangles whose corners were given anew, in each instance
    std::vector<uint32_t> placed;   // chunks with a new transform
    std::vector<PrimRange> removed; // whole chunks, with the triangles that they had
    bool added = false;

    bool any() const { return added || !moved.empty() || !placed.empty() || !removed.empty(); }
};

} // namespace ovc
