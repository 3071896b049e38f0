// SPDX-License-Identifier: Apache-2.0
// UniqueVertices turns corners that agree bit for bit into one vertex, in the order of their first
// use.
#pragma once

#include "core/vec.h"

#include <bit>
#include <cassert>
#include <cstdint>
#include <vector>

namespace ovc {

class UniqueVertices {
public:
    /// Returns the number of the vertex at `position`, which is new at its first use.
    uint32_t add(const dvec3& position) {
        if (2 * (vertices_.size() + 1) > slots_.size())
            grow();
        uint32_t& slot = slots_[slot_of(position)];
        if (slot == kEmpty) {
            slot = uint32_t(vertices_.size());
            vertices_.push_back(position);
        }
        return slot;
    }

    const std::vector<dvec3>& vertices() const { return vertices_; }

private:
    static constexpr uint32_t kEmpty = 0xffffffffu;

    static bool same(const dvec3& a, const dvec3& b) {
        // Comparing bits, 0 and -0 differ, and a NaN equals itself.
        return std::bit_cast<uint64_t>(a.x) == std::bit_cast<uint64_t>(b.x) &&
               std::bit_cast<uint64_t>(a.y) == std::bit_cast<uint64_t>(b.y) &&
               std::bit_cast<uint64_t>(a.z) == std::bit_cast<uint64_t>(b.z);
    }

    static uint64_t hash(const dvec3& v) {
        uint64_t h = 0;
        for (int axis = 0; axis < 3; ++axis) {
            h = (h ^ std::bit_cast<uint64_t>(v[axis])) *
                0x9e3779b97f4a7c15; // 2^64 over the golden ratio
            h ^= h >> 32;
        }
        return h;
    }

    /// Returns the slot of the vertex, or where it would go. At least half of the slots are empty,
    /// so the search ends.
    size_t slot_of(const dvec3& position) const {
        assert(std::has_single_bit(slots_.size()) && 2 * vertices_.size() <= slots_.size());
        size_t at = hash(position) & (slots_.size() - 1);
        while (slots_[at] != kEmpty && !same(vertices_[slots_[at]], position))
            at = (at + 1) & (slots_.size() - 1);
        return at;
    }

    void grow() {
        slots_.assign(std::max<size_t>(64, 2 * slots_.size()), kEmpty);
        for (size_t i = 0; i < vertices_.size(); ++i)
            slots_[slot_of(vertices_[i])] = uint32_t(i);
    }

    std::vector<dvec3> vertices_;
    std::vector<uint32_t> slots_;
};

} // namespace ovc
