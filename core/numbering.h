// SPDX-License-Identifier: Apache-2.0
// Numbering: names each triangle of a soup by one 32-bit number.
#pragma once

#include "core/soup.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc {

/// Counts triangles in the order of their ids. The soup must have fewer than 2^32 of them.
class Numbering {
public:
    Numbering() = default;
    /// first: of the first triangle.
    explicit Numbering(const Soup& soup, uint32_t first = 0) : first_{first} { append(soup); }

    /// Numbers the triangles of chunks that the soup has got since. Those before keep theirs.
    void append(const Soup& soup) {
        first_.reserve(soup.chunks.size() + 1);
        for (size_t mesh = meshes(); mesh < soup.chunks.size(); ++mesh)
            first_.push_back(first_.back() + soup.chunks[mesh].size());
    }
    uint64_t meshes() const { return first_.size() - 1; }
    uint32_t first() const { return first_.front(); }
    /// Returns the number behind the last that is given, also to chunks that are empty now.
    uint64_t count() const { return first_.back(); }

    uint32_t of(TriangleId id) const {
        assert(id.mesh < meshes() && id.prim < first_[id.mesh + 1] - first_[id.mesh]);
        return first_[id.mesh] + id.prim;
    }

    TriangleId id(uint32_t number) const {
        assert(number < first_.back());
        if (first_.size() == 2)
            return {0, number - first_.front()};
        // The last chunk that begins at or before the number holds it; empty ones may precede.
        const auto after = std::upper_bound(first_.begin(), first_.end(), number);
        const uint32_t mesh = uint32_t(after - first_.begin()) - 1;
        return {mesh, number - first_[mesh]};
    }

private:
    std::vector<uint32_t> first_{0}; // of each chunk, and behind the last the count of all
};

} // namespace ovc
