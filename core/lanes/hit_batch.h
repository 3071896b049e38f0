// SPDX-License-Identifier: Apache-2.0
// HitBatch: collects hits that are known to be the nearest, to compute t, u and v of several at
// once.
#pragma once

#include "core/lanes/hit_lanes.h"
#include "core/lanes/lane_batch.h"

namespace ovc {

/// Tag: whatever the caller wants back with each hit.
template <class Tag>
class HitBatch {
public:
    bool full() const { return batch_.full(); }

    /// Adds a ray and the triangle that it hits. Needs room: not full().
    /// The ray stays where it is until the batch is empty.
    void add(const RaySpan& rays, size_t i, const Soup& soup, TriangleId id, const Tag& tag) {
        batch_.add(rays, i, soup, id, {id, tag});
    }

    /// Empties the batch. Calls found(hit, tag) for each hit, t, u and v rounded once; or
    /// unclear(tag) where only exact arithmetic can tell them, or where the ray does not seem to
    /// hit the triangle.
    template <class Found, class Unclear>
    void finish(Found&& found, Unclear&& unclear) {
        batch_.finish(round_hits, [&](const HitLanes& lanes, int lane, const Entry& entry) {
            const double t = lanes.t[lane], u = lanes.u[lane], v = lanes.v[lane];
            // Nearer to a side, or at an end of the ray, roundings may hide that the ray passes it,
            // or ends before.
            const bool inside = u > 0 && v > 0 && u + v <= 1 - 0x1p-50;
            const Ray& ray = lanes.ray(lane);
            if (lanes.known[lane] == HitLanes::kAll && inside && t > ray.t_min && t < ray.t_max)
                found(Hit{t, u, v, entry.id}, entry.tag);
            else
                unclear(entry.tag);
        });
    }

private:
    struct Entry {
        TriangleId id;
        Tag tag;
    };

    LaneBatch<HitLanes, Entry> batch_;
};

} // namespace ovc
