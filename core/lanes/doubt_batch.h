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

    /// Adds a ray and a triangle. Needs room. The ray stays where it is until the batch is empty.
    void add(const Ray* ray, const Triangle& triangle, TriangleId id, const Tag& tag) {
        batch_.add(ray, triangle, {id, tag});
    }
    void add(const RaySpan& rays, size_t i, const Soup& soup, TriangleId id, const Tag& tag) {
        batch_.add(rays, i, soup, id, {id, tag});
    }

    /// Empties the batch. Calls answered(answer, triangle, id, tag) for each pair, in the order in
    /// which they were added; the answer is that of refined_candidate().
    template <class Answered>
    void finish(Answered&& answered) {
        batch_.finish(
            [&](const MeetingLanes& lanes, int count) { solve(lanes, count, solutions_); },
            [&](const MeetingLanes& lanes, int lane, const Entry& entry) {
                // No t beyond the largest double can be told.
                const Ray& ray = lanes.ray(lane);
                const double t_max = std::min(ray.t_max, std::numeric_limits<double>::max());
                answered(solutions_.missed[lane]
                             ? RefinedAnswer{true, std::nullopt}
                             : refined_candidate(solutions_.at(lane), ray.t_min, t_max, entry.id),
                         lanes.triangle(lane), entry.id, entry.tag);
            });
    }

private:
    struct Entry {
        TriangleId id;
        Tag tag;
    };

    LaneBatch<MeetingLanes, Entry> batch_;
    SolutionLanes solutions_;
};

} // namespace ovc
