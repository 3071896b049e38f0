// SPDX-License-Identifier: Apache-2.0
// HitBatch: collects hits that are known to be the nearest, to compute t, u and v of several at
// once.
#pragma once

#include "core/lanes/hit_lanes.h"
#include "core/ray.h"
#include "core/soup.h"

#include <array>
#include <cassert>
#include <cstddef>

namespace ovc {

/// Tag: whatever the caller wants back with each hit.
template <class Tag>
class HitBatch {
public:
    bool full() const { return count_ == HitLanes::kCount; }

    /// Adds a ray and the triangle that it hits. Needs room: not full().
    void add(const Ray& ray, const Triangle& triangle, TriangleId id, const Tag& tag) {
        assert(!full());
        lanes_.set(count_, ray, triangle);
        entries_[size_t(count_++)] = {ray.t_min, ray.t_max, id, tag};
    }

    /// Empties the batch. Calls found(hit, tag) for each hit, t, u and v rounded once; or
    /// unclear(tag) where only exact arithmetic can tell them, or where the ray does not seem to
    /// hit the triangle.
    template <class Found, class Unclear>
    void finish(Found&& found, Unclear&& unclear) {
        if (count_ == 0)
            return;
        round_hits(lanes_, count_);
        for (int lane = 0; lane < count_; ++lane) {
            const Entry& entry = entries_[size_t(lane)];
            const double t = lanes_.t[lane], u = lanes_.u[lane], v = lanes_.v[lane];
            const bool inside = u >= 0 && v >= 0 && u + v <= 1;
            if (lanes_.known[lane] == HitLanes::kAll && inside && t >= entry.t_min &&
                t <= entry.t_max)
                found(Hit{t, u, v, entry.id}, entry.tag);
            else
                unclear(entry.tag);
        }
        count_ = 0;
    }

private:
    struct Entry {
        double t_min, t_max;
        TriangleId id;
        Tag tag;
    };

    HitLanes lanes_{};
    std::array<Entry, HitLanes::kCount> entries_{};
    int count_ = 0;
};

} // namespace ovc
