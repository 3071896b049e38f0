// SPDX-License-Identifier: Apache-2.0
// RoundingBatch: collects hits that exact arithmetic has decided, to round t, u and v of several at
// once.
#pragma once

#include "core/exact/refined.h"

#include <array>
#include <cassert>
#include <cstddef>

namespace ovc {

/// Tag: whatever the caller wants back with each hit.
template <class Tag>
class RoundingBatch {
public:
    bool full() const { return count_ == HitLanes::kCount; }

    /// Adds a ray and the triangle that it hits. support: as in Candidate. Needs room: not full().
    void add(const Ray& ray, const Triangle& triangle, TriangleId id, uint32_t support,
             const Tag& tag) {
        assert(!full());
        lanes_.set(count_, ray, triangle);
        entries_[size_t(count_++)] = {id, support, tag};
    }

    /// Empties the batch. Calls rounded(hit, tag) for each hit, t, u and v rounded once.
    template <class Rounded>
    void finish(Rounded&& rounded) {
        if (count_ == 0)
            return;
        round_hits(lanes_, count_);
        for (int lane = 0; lane < count_; ++lane) {
            const Entry& entry = entries_[size_t(lane)];
            rounded(rounded_hit(lanes_, lane, entry.id, entry.support), entry.tag);
        }
        count_ = 0;
    }

private:
    struct Entry {
        TriangleId id;
        uint32_t support;
        Tag tag;
    };

    HitLanes lanes_{};
    std::array<Entry, HitLanes::kCount> entries_{};
    int count_ = 0;
};

} // namespace ovc
