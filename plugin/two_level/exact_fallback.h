// SPDX-License-Identifier: Apache-2.0
// The exact fallback: traces a ray that float32 could not decide in double, down the top-level tree
// and through the pages. Its answers equal those of the CPU KD-tree
// (kdtree/traverse.h) bit for bit, because both test with core/exact/triangle.h every triangle that
// could be hit.
#pragma once

#include "core/lanes/cull_batch.h"
#include "kdtree/approach.h"
#include "plugin/two_level/scene_walk.h"
#include "shaders/layout.h"

#include <array>
#include <optional>
#include <utility>

namespace ovc {

/// Tests the triangles on the way of a ray: the first as they come, because most rays meet few, and
/// the others many at once.
template <bool kAnyHit>
class WayTest {
public:
    WayTest(const BuiltScene& scene, const PreparedRay& p)
        : scene_(scene), p_(p), nearest_(scene.nearest_of(p)), approach_(p, scene.level1.bounds) {}

    /// Tests a triangle by its number, now or later. Returns whether the ray needs no other.
    bool test(uint32_t number) {
        if (++met_ <= kOneByOne)
            return offer(scene_.numbers.id(number));
        if (!many_)
            many_.emplace(p_, nearest_);
        if (!many_->recent.is_new(number))
            return false;
        many_->batch.add(scene_.numbers.id(number));
        return many_->batch.full() && finish();
    }
    /// Tests what is left.
    bool finish() {
        if (!many_)
            return false;
        const auto put = [&](TriangleId id, double* to) {
            scene_.soup.chunks[id.mesh].put_triangle<CullBatch::kStride>(id.prim, to);
        };
        return many_->batch.finish(put, [&](TriangleId id) { return offer(id); });
    }

    const Approach& approach() const { return approach_; }
    double limit() const { return approach_.limit(nearest_); }
    Hit hit() const { return kAnyHit ? nearest_.unrounded_hit() : nearest_.hit(); }

private:
    static constexpr uint32_t kOneByOne = 32;

    /// The triangles met of late. Leaves that overlap name a triangle again and again.
    class Recent {
    public:
        Recent() { numbers_.fill(OVC_NO_TRIANGLE); }
        bool is_new(uint32_t number) {
            return std::exchange(numbers_[number % numbers_.size()], number) != number;
        }

    private:
        std::array<uint32_t, 4096> numbers_; // which push each other out
    };
    struct Many {
        Many(const PreparedRay& p, const Nearest& nearest) : batch(p, nearest) {}

        CullBatch batch;
        Recent recent;
    };

    bool offer(TriangleId id) {
        const bool hit = scene_.offer(nearest_, p_, id);
        if (hit)
            approach_.note_hit(scene_.soup.triangle(id));
        return hit && kAnyHit;
    }

    const BuiltScene& scene_;
    const PreparedRay& p_;
    Nearest nearest_;
    Approach approach_;
    std::optional<Many> many_;
    uint32_t met_ = 0;
};

/// Returns the nearest hit of a valid ray, or with kAnyHit some hit. Any thread.
template <bool kAnyHit>
Hit trace_exactly(const BuiltScene& scene, const PreparedRay& p) {
    WayTest<kAnyHit> way(scene, p);
    const PreparedRay& ray = way.approach().ray();
    const auto test = [&](uint32_t number) { return way.test(number); };
    const auto limit = [&] { return way.limit(); };
    if (!walk_scene(scene, ray, test, limit))
        way.finish();
    return way.hit();
}

} // namespace ovc
