// SPDX-License-Identifier: Apache-2.0
// CullBatch: collects triangles that rays may meet. RayCull: offers a ray those that may be its
// nearest hit.
#pragma once

#include "core/exact/triangle.h"
#include "core/lanes/cull_lanes.h"

#include <array>
#include <bit>
#include <cassert>
#include <cstdint>
#include <optional>

namespace ovc {

/// Returns the name of a triangle for cull().
inline long long key_of(TriangleId id) {
    return std::bit_cast<long long>((uint64_t(id.mesh) << 32 | id.prim) ^ uint64_t(1) << 63);
}
/// Returns the ray for cull(), without a hit. near: one of the triangles, which is finite. A ray
/// from far away tells triangles apart that are as small as this one.
CullRay cull_ray(const PreparedRay& p, const Triangle& near);
/// Notes the nearest hit so far.
void note_hit(CullRay& ray, const PreparedRay& p, const ComparedHit& nearest);

/// Triangles in lanes, for one ray or several.
class CullBatch {
public:
    static constexpr uint32_t kCount = 64;
    static constexpr size_t kStride = CullLanes::kCount;

    uint32_t count() const { return count_; }
    bool full() const { return count_ == kCount; }
    /// Returns a bit for each triangle.
    uint64_t all() const { return full() ? ~uint64_t(0) : (uint64_t(1) << count_) - 1; }

    /// Adds a triangle. Needs room: not full().
    void add(TriangleId id) {
        assert(!full());
        ids_[count_++] = id;
    }
    /// Makes the triangles ready for RayCull. Calls put(id, to) for all to write their coordinates
    /// as Chunk::put_triangle<kStride>() does.
    template <class Put>
    void fetch(Put&& put) {
        for (uint32_t i = 0; i < count_; ++i) {
            CullLanes& lanes = lanes_[i / kLanes];
            const uint32_t lane = i % kLanes;
            put(ids_[i], &lanes.corner[0][0][lane]);
            lanes.key[lane] = key_of(ids_[i]);
        }
    }
    void clear() { count_ = 0; }

private:
    friend class RayCull;
    static constexpr uint32_t kLanes = CullLanes::kCount;

    Triangle triangle(uint32_t i) const;
    /// Returns the smallest triangle. The batch is not empty.
    Triangle smallest() const;

    std::array<CullLanes, kCount / kLanes> lanes_{};
    std::array<TriangleId, kCount> ids_;
    uint32_t count_ = 0;
};

/// Culls for the Nearest of one ray, which both outlive this.
class RayCull {
public:
    RayCull(const PreparedRay& p, const Nearest& nearest) : p_(p), nearest_(nearest) {}

    /// Calls offer(id) -> bool (true: stop) for those triangles of the batch that may be the
    /// nearest, until a call stops it; returns whether one did. offer() offers the triangle to the
    /// Nearest. left: a bit for each triangle that the ray may meet. The batch has been fetched.
    template <class Offer>
    bool offer_left(CullBatch& batch, uint64_t left, Offer&& offer) {
        // The first hits of a batch leave little of it. Where they do not, culling again and again
        // would take longer than it saves.
        constexpr int kMaxCulls = 4;
        for (int culls = 0; left != 0;) {
            if (culls == 0 || (culls < kMaxCulls && has_new_hit())) {
                left = cull_all(batch, left);
                ++culls;
                continue;
            }
            const uint32_t first = first_of(batch, left);
            left &= ~(uint64_t(1) << first);
            if (offer(batch.ids_[first]))
                return true;
        }
        return false;
    }

private:
    static constexpr uint32_t kLanes = CullBatch::kLanes;

    bool has_new_hit() const { return nearest_.is_hit() && nearest_.unrounded_hit().id != noted_; }
    /// Returns which of the triangles `left` may be the nearest, a bit each.
    uint64_t cull_all(CullBatch& batch, uint64_t left);
    /// Returns the one of `left` (not 0) that is probably the nearest.
    static uint32_t first_of(const CullBatch& batch, uint64_t left);

    const PreparedRay& p_;
    const Nearest& nearest_;
    std::optional<CullRay> ray_;
    TriangleId noted_; // whose hit ray_ has
};

} // namespace ovc
