// SPDX-License-Identifier: Apache-2.0
// DoubtBatch: collects rays and triangles that doubles leave in doubt, to test several pairs at
// once in doubled precision.
#pragma once

#include "core/exact/refined.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstddef>
#include <limits>

namespace ovc {

/// Tag: whatever the caller wants back with each pair.
template <class Tag>
class DoubtBatch {
public:
    int room() const { return MeetingLanes::kCount - count_; }
    bool empty() const { return count_ == 0; }

    /// Adds a ray and a triangle. Needs room.
    void add(const Ray& ray, const Triangle& triangle, TriangleId id, const Tag& tag) {
        assert(room() > 0);
        lanes_.set(count_, ray, triangle);
        // No t beyond the largest double can be told.
        entries_[size_t(count_++)] = {
            ray.t_min, std::min(ray.t_max, std::numeric_limits<double>::max()), id, tag};
    }

    /// Empties the batch. Calls answered(answer, triangle, id, tag) for each pair, in the order in
    /// which they were added; the answer is that of refined_candidate().
    template <class Answered>
    void finish(Answered&& answered) {
        if (empty())
            return;
        solve(lanes_, count_, solutions_);
        for (int lane = 0; lane < count_; ++lane) {
            const Entry& entry = entries_[size_t(lane)];
            answered(refined_candidate(solutions_.at(lane), entry.t_min, entry.t_max, entry.id),
                     lanes_.triangle(lane), entry.id, entry.tag);
        }
        count_ = 0;
    }

private:
    struct Entry {
        double t_min, t_max;
        TriangleId id;
        Tag tag;
    };

    MeetingLanes lanes_{};
    SolutionLanes solutions_;
    std::array<Entry, MeetingLanes::kCount> entries_{};
    int count_ = 0;
};

} // namespace ovc
