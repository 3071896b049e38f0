// SPDX-License-Identifier: Apache-2.0
// LaneBatch: collects rays and triangles until several pairs are computed at once. HitBatch,
// RoundingBatch and DoubtBatch say what of.
#pragma once

#include "core/ray_span.h"
#include "core/soup.h"

#include <array>
#include <cassert>
#include <cstddef>

namespace ovc {

/// Lanes: MeetingLanes, or some with more. Entry: what a pair has besides its lane.
template <class Lanes, class Entry>
class LaneBatch {
public:
    int room() const { return Lanes::kCount - count_; }
    bool full() const { return room() == 0; }
    bool empty() const { return count_ == 0; }

    /// Adds a pair. Needs room. The ray stays where it is until the batch is empty.
    void add(const Ray* ray, const Triangle& triangle, const Entry& entry) {
        assert(!full());
        lanes_.set(count_, ray, triangle);
        entries_[size_t(count_++)] = entry;
    }
    /// Does the same for one of many rays and a triangle of a soup.
    void add(const RaySpan& rays, size_t i, const Soup& soup, TriangleId id, const Entry& entry) {
        assert(!full() && soup.has(id));
        const size_t lane = size_t(count_++);
        lanes_.set(int(lane), rays.address(i, room_.rays[lane]), soup.chunks[id.mesh], id.prim);
        entries_[lane] = entry;
    }

    /// Empties the batch: calls compute(lanes, count), unless there is nothing in it, and then
    /// take(lanes, lane, entry) for each pair, in the order in which they were added.
    template <class Compute, class Take>
    void finish(Compute&& compute, Take&& take) {
        if (empty())
            return;
        compute(lanes_, count_);
        for (int lane = 0; lane < count_; ++lane)
            take(lanes_, lane, entries_[size_t(lane)]);
        count_ = 0;
    }

private:
    // Lanes that are not in use are not written: most batches live for a few pairs.
    Lanes lanes_;
    std::array<Entry, Lanes::kCount> entries_;
    RayRoom<Lanes::kCount> room_;
    int count_ = 0;
};

} // namespace ovc
