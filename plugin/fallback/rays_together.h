// SPDX-License-Identifier: Apache-2.0
// RaysTogether: the exact fallback for rays that meet many triangles each. Most of such a ray's
// time is spent on reading the tree and the triangles, so that rays which go the same way share it.
#pragma once

#include "core/lanes/cull_batch.h"
#include "kdtree/approach.h"
#include "plugin/fallback/scene_walk.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <deque>
#include <limits>
#include <utility>

namespace ovc {

/// Traces up to kMaxRays valid rays, to the nearest hit, or with kAnyHit to some hit.
template <bool kAnyHit>
class RaysTogether {
public:
    static constexpr size_t kMaxRays = NodeRays::kMax;

    /// scene outlives this.
    explicit RaysTogether(const BuiltScene& scene) : scene_(scene) {}

    /// Adds a ray. near: a triangle that it hits, which makes the others' tests cheaper; or none.
    void add(const PreparedRay& p, TriangleId near) {
        assert(rays_.size() < kMaxRays);
        OneRay& ray = rays_.emplace_back(scene_, p);
        if (scene_.soup.has(near))
            ray.is_done = offer(ray, near);
        limits_[rays_.size() - 1] = ray.limit();
    }

    /// Traces all that were added. keeps_on() -> bool is asked now and then; where it returns false
    /// the answers are incomplete.
    template <class KeepsOn>
    void trace(KeepsOn&& keeps_on) {
        const auto test = [&](uint32_t number, RaySet rays) {
            return add_triangle(number, rays) && (finish() || !keeps_on());
        };
        const auto prepared = [&](uint32_t r) -> const PreparedRay& {
            return rays_[r].approach.ray();
        };
        const auto limit = [&](uint32_t r, double) { return limits_[r]; };
        const RaySet all = RaySet((uint64_t(1) << rays_.size()) - 1);
        if (!walk_scene_together(scene_, all, prepared, test, limit))
            finish();
    }

    /// Returns the hit of the i-th ray that was added.
    Hit hit(size_t i) const {
        const Nearest& nearest = rays_[i].nearest;
        return kAnyHit ? nearest.unrounded_hit() : nearest.hit();
    }

private:
    struct OneRay {
        PreparedRay p;
        Nearest nearest;
        Approach approach;
        RayCull cull;
        bool is_done = false;

        OneRay(const BuiltScene& scene, const PreparedRay& p_)
            : p(p_),
              nearest(scene.nearest_of(p)),
              approach(p, scene.level1.bounds),
              cull(p, nearest) {}

        double limit() const {
            return is_done ? -std::numeric_limits<double>::infinity() : approach.limit(nearest);
        }
    };

    /// The triangles met of late. Leaves that overlap name a triangle again and again.
    class Recent {
    public:
        Recent() { numbers_.fill(OVC_NO_TRIANGLE); }
        /// Returns those of the rays that did not meet the triangle of late.
        RaySet new_to(uint32_t number, RaySet rays) {
            const size_t slot = number % numbers_.size();
            if (std::exchange(numbers_[slot], number) != number)
                return rays_[slot] = rays;
            return rays & ~std::exchange(rays_[slot], rays_[slot] | rays);
        }

    private:
        std::array<uint32_t, 4096> numbers_; // which push each other out
        std::array<RaySet, 4096> rays_{};
    };

    /// Returns whether the batch is full.
    bool add_triangle(uint32_t number, RaySet rays) {
        rays = recent_.new_to(number, rays);
        if (rays == 0)
            return false;
        met_by_[batch_.count()] = rays;
        met_by_all_ &= rays;
        met_by_any_ |= rays;
        batch_.add(scene_.numbers.id(number));
        return batch_.full();
    }

    /// Returns which triangles of the batch ray r may meet, a bit each.
    uint64_t met_by(uint32_t r) const {
        uint64_t met = 0;
        if (met_by_all_ >> r & 1)
            return batch_.all();
        for (uint32_t i = 0; i < batch_.count(); ++i)
            met |= uint64_t(met_by_[i] >> r & 1) << i;
        return met;
    }

    /// Tests the triangles of the batch. Returns whether no ray needs another.
    bool finish() {
        batch_.fetch([&](TriangleId id, double* to) {
            scene_.soup.chunks[id.mesh].put_triangle<CullBatch::kStride>(id.prim, to);
        });
        for_each_ray(met_by_any_, [&](uint32_t r) {
            OneRay& ray = rays_[r];
            ray.is_done = ray.is_done || ray.cull.offer_left(batch_, met_by(r), [&](TriangleId id) {
                return offer(ray, id);
            });
            limits_[r] = ray.limit();
        });
        batch_.clear();
        met_by_all_ = ~RaySet(0);
        met_by_any_ = 0;
        return std::ranges::all_of(rays_, &OneRay::is_done);
    }

    /// Returns whether the ray is done.
    bool offer(OneRay& ray, TriangleId id) {
        const bool hit = scene_.offer(ray.nearest, ray.p, id);
        if (hit)
            ray.approach.note_hit(scene_.soup.triangle(id));
        return hit && kAnyHit;
    }

    const BuiltScene& scene_;
    std::deque<OneRay> rays_;             // which refer to parts of themselves, and must not move
    std::array<double, kMaxRays> limits_; // of the rays, beyond which nothing can win
    CullBatch batch_;
    std::array<RaySet, CullBatch::kCount> met_by_; // the rays that may meet each of its triangles
    RaySet met_by_all_ = ~RaySet(0);               // those that may meet all of them
    RaySet met_by_any_ = 0;                        // those that may meet any of them
    Recent recent_;
};

} // namespace ovc
