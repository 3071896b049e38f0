// SPDX-License-Identifier: Apache-2.0
// DoubtBatch: collects rays and triangles that doubles leave in doubt, to test several pairs at
// once in doubled precision.
#pragma once

#include "core/exact/refined.h"
#include "core/lanes/lane_batch.h"

#include <algorithm>
#include <limits>

namespace ovc {

/// Tag: whatever the caller wants back with each pair.
template <class Tag>
class DoubtBatch {
public:
    int room() const { return batch_.room(); }
    bool empty() const { return batch_.empty(); }

    /// Adds a ray and a triangle. Needs room.
    void add(const Ray& ray, const Triangle& triangle, TriangleId id, const Tag& tag) {
        // No t beyond the largest double can be told.
        const double t_max = std::min(ray.t_max, std::numeric_limits<double>::max());
        batch_.add(ray, triangle, {ray.t_min, t_max, id, tag});
    }

    /// Empties the batch. Calls answered(answer, triangle, id, tag) for each pair, in the order in
    /// which they were added; the answer is that of refined_candidate().
    template <class Answered>
    void finish(Answered&& answered) {
        batch_.finish(
            [&](const MeetingLanes& lanes, int count) { solve(lanes, count, solutions_); },
            [&](const MeetingLanes& lanes, int lane, const Entry& entry) {
                answered(solutions_.missed[lane]
                             ? RefinedAnswer{true, std::nullopt}
                             : refined_candidate(solutions_.at(lane), entry.t_min, entry.t_max,
                                                 entry.id),
                         lanes.triangle(lane), entry.id, entry.tag);
            });
    }

private:
    struct Entry {
        double t_min, t_max;
        TriangleId id;
        Tag tag;
    };

    LaneBatch<MeetingLanes, Entry> batch_;
    SolutionLanes solutions_;
};

} // namespace ovc
