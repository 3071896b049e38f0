// SPDX-License-Identifier: Apache-2.0
// The exact fallback: traces a ray that float32 could not decide in double, down the top-level tree
// and through the pages. Its answers equal those of the CPU KD-tree
// (kdtree/traverse.h) bit for bit, because both test with core/exact/triangle.h every triangle that
// could be hit.
#pragma once

#include "core/exact/refined.h"
#include "kdtree/approach.h"
#include "plugin/fallback/rays_together.h"
#include "plugin/fallback/scene_walk.h"

namespace ovc {

/// Tests the triangles on the way of a ray one by one, because most rays meet few.
template <bool kAnyHit>
class FewTest {
public:
    FewTest(const BuiltScene& scene, const PreparedRay& p)
        : scene_(scene), p_(p), nearest_(scene.nearest_of(p)), approach_(p, scene.level1.bounds) {}

    /// Tests a triangle by its number. Returns whether the ray needs no other, or gives up.
    bool test(uint32_t number) {
        gives_up_ = met_++ == kFew;
        return gives_up_ || offer(scene_.numbers.id(number));
    }
    /// Whether the ray met too many triangles.
    bool gives_up() const { return gives_up_; }

    const Approach& approach() const { return approach_; }
    double limit() const { return approach_.limit(nearest_); }
    /// Returns the nearest of the triangles that the ray hits, or with kAnyHit some of them.
    const Candidate& found() const { return nearest_.best().found; }

private:
    static constexpr uint32_t kFew = 32;

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
    uint32_t met_ = 0;
    bool gives_up_ = false;
};

/// What trace_few() found.
struct FewFound {
    bool is_answer = false; // false: the ray meets too many triangles
    Candidate found;        // the hit, not rounded; else one of the ray, or none, for RaysTogether
};

/// Traces a valid ray to its nearest hit, or with kAnyHit to some hit. Any thread.
template <bool kAnyHit>
FewFound trace_few(const BuiltScene& scene, const PreparedRay& p) {
    FewTest<kAnyHit> few(scene, p);
    walk_scene(
        scene, few.approach().ray(), [&](uint32_t number) { return few.test(number); },
        [&] { return few.limit(); });
    return {!few.gives_up(), few.found()};
}

/// Returns the nearest hit of a valid ray, or with kAnyHit some hit. Any thread.
template <bool kAnyHit>
Hit trace_exactly(const BuiltScene& scene, const PreparedRay& p) {
    const auto [is_answer, found] = trace_few<kAnyHit>(scene, p);
    const TriangleId id = found.hit.id;
    if (is_answer && (kAnyHit || !found.hit.is_hit()))
        return found.hit;
    if (is_answer)
        return rounded_hit(p, scene.soup.triangle(id), id, found.support);
    RaysTogether<kAnyHit> alone(scene);
    alone.add(p, id);
    alone.trace([] { return true; });
    return alone.hit(0);
}

} // namespace ovc
