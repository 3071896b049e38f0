// SPDX-License-Identifier: Apache-2.0
// RoundingBatch: collects hits that exact arithmetic has decided, to round t, u and v of several at
// once.
#pragma once

#include "core/exact/refined.h"
#include "core/lanes/lane_batch.h"

namespace ovc {

/// Tag: whatever the caller wants back with each hit.
template <class Tag>
class RoundingBatch {
public:
    bool full() const { return batch_.full(); }

    /// Adds a ray and the triangle that it hits. support: as in Candidate. Needs room: not full().
    /// The ray stays where it is until the batch is empty.
    void add(const RaySpan& rays, size_t i, const Soup& soup, TriangleId id, uint32_t support,
             const Tag& tag) {
        batch_.add(rays, i, soup, id, {id, support, tag});
    }

    /// Empties the batch. Calls rounded(hit, tag) for each hit, t, u and v rounded once.
    template <class Rounded>
    void finish(Rounded&& rounded) {
        batch_.finish(round_hits, [&](const HitLanes& lanes, int lane, const Entry& entry) {
            rounded(rounded_hit(lanes, lane, entry.id, entry.support), entry.tag);
        });
    }

private:
    struct Entry {
        TriangleId id;
        uint32_t support;
        Tag tag;
    };

    LaneBatch<HitLanes, Entry> batch_;
};

} // namespace ovc
