// SPDX-License-Identifier: Apache-2.0
// Numbering: names each triangle of a soup by one 32-bit number.
#pragma once

#include "core/soup.h"

#include <algorithm>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc {

/// Counts triangles from 0 in the order of their ids. The soup must have fewer than 2^32 of them.
class Numbering {
public:
    Numbering() = default;
    explicit Numbering(const Soup& soup) {
        first_.reserve(soup.chunks.size() + 1);
        uint32_t count = 0;
        for (const Chunk& chunk : soup.chunks) {
            first_.push_back(count);
            count += chunk.size();
        }
        first_.push_back(count);
    }

    /// Returns whether the soup has such a triangle.
    bool has(TriangleId id) const {
        return id.mesh + size_t(1) < first_.size() &&
               id.prim < first_[id.mesh + 1] - first_[id.mesh];
    }

    uint32_t of(TriangleId id) const {
        assert(has(id));
        return first_[id.mesh] + id.prim;
    }

    TriangleId id(uint32_t number) const {
        assert(!first_.empty() && number < first_.back());
        // The last chunk that begins at or before the number holds it; empty ones may precede.
        const auto after = std::upper_bound(first_.begin(), first_.end(), number);
        const uint32_t mesh = uint32_t(after - first_.begin()) - 1;
        return {mesh, number - first_[mesh]};
    }

private:
    std::vector<uint32_t> first_; // of each chunk, and behind the last the count of all
};

} // namespace ovc
