// SPDX-License-Identifier: Apache-2.0
// The exact fallback: traces a ray that float32 could not decide in double, down the top-level tree
// and through the pages. Its answers equal those of the CPU KD-tree
// (kdtree/traverse.h) bit for bit, because both test with core/exact/triangle.h every triangle that
// could be hit.
#pragma once

#include "core/exact/refined.h"
#include "core/lanes/doubt_batch.h"
#include "kdtree/approach.h"
#include "plugin/fallback/rays_together.h"
#include "plugin/fallback/scene_walk.h"

#include <algorithm>
#include <limits>
#include <optional>

namespace ovc {

/// Tests the triangles on the way of a ray, because most rays meet few. Those that doubles leave in
/// doubt, as at a corner that the ray is aimed at, are tested together.
template <bool kAnyHit>
class FewTest {
public:
    FewTest(const BuiltScene& scene, const PreparedRay& p)
        : scene_(scene), p_(p), nearest_(scene.nearest_of(p)), approach_(p, scene.level1.bounds) {}

    /// Tests a triangle by its number, now or later. Returns whether the ray needs no other, or
    /// gives up.
    bool test(uint32_t number) {
        gives_up_ = met_++ == kFew;
        return gives_up_ || offer(number);
    }
    /// Whether the ray met too many triangles.
    bool gives_up() const { return gives_up_; }

    const Approach& approach() const { return approach_; }
    /// Returns the limit for what the ray enters at that t.
    double limit(double enter) {
        if (enter > doubt_ends_)
            decide();
        return is_done_ ? -kInfinity : approach_.limit(nearest_);
    }
    /// Tests what is left. Returns the nearest of the triangles that the ray hits, or with kAnyHit
    /// some of them.
    const Candidate& found() {
        decide();
        return nearest_.best().found;
    }

private:
    static constexpr uint32_t kFew = 32;
    static constexpr double kInfinity = std::numeric_limits<double>::infinity();
    struct NoTag {};

    bool offer(uint32_t number) {
        const TriangleId id = scene_.numbers.id(number);
        // Hits in the corner of the nearest one, and those behind some place, are told by names.
        const bool at_once = !p_.after.is_before_all() || approach_.is_moved() ||
                             nearest_.best().found.support != Candidate::kAllCorners;
        if (!at_once)
            return offer_plainly(scene_.seen(id, p_.skip));
        is_done_ = note(scene_.offer(nearest_, p_, id), scene_.soup.triangle(id));
        return is_done_;
    }

    bool offer_plainly(TriangleId id) {
        const Triangle triangle = scene_.soup.triangle(id);
        bool in_doubt = false;
        const std::optional<Candidate> found =
            candidate(p_, triangle, id, [&](auto&&...) -> std::optional<Candidate> {
                in_doubt = true;
                return std::nullopt;
            });
        if (!in_doubt) {
            is_done_ = found && note(nearest_.enter(*found, triangle), triangle);
            return is_done_;
        }
        doubts_.add(&p_.ray, triangle, id, {});
        const double ends = latest_t(triangle);
        doubt_ends_ =
            doubts_.room() == MeetingLanes::kCount - 1 ? ends : std::max(doubt_ends_, ends);
        if (doubts_.room() == 0)
            decide();
        return is_done_;
    }

    /// Returns about the t at which the ray leaves the depth of the triangle.
    double latest_t(const Triangle& triangle) const {
        const int z = p_.kz;
        const auto t = [&](const dvec3& corner) { return (corner[z] - p_.ray.org[z]) * p_.sz; };
        return std::max({t(triangle[0]), t(triangle[1]), t(triangle[2])});
    }

    void decide() {
        doubts_.finish([&](const RefinedAnswer& answer, const Triangle& triangle, TriangleId id,
                           NoTag) {
            const bool hit = answer.known
                                 ? answer.candidate && nearest_.enter(*answer.candidate, triangle)
                                 : nearest_.offer(triangle, id);
            is_done_ = note(hit, triangle) || is_done_;
        });
        doubt_ends_ = kInfinity;
    }

    /// Returns whether the ray, which hits the triangle or not, needs no other.
    bool note(bool hit, const Triangle& triangle) {
        if (hit)
            approach_.note_hit(triangle);
        return hit && kAnyHit;
    }

    const BuiltScene& scene_;
    const PreparedRay& p_;
    Nearest nearest_;
    Approach approach_;
    DoubtBatch<NoTag> doubts_;
    double doubt_ends_ = kInfinity; // where triangles in doubt may begin to hide what comes behind
    uint32_t met_ = 0;
    bool gives_up_ = false;
    bool is_done_ = false;
};

/// The result of trace_few().
struct FewFound {
    bool is_answer = false; // false: the ray meets too many triangles
    Candidate found;        // the hit, not rounded; else one of the ray, or none, for RaysTogether
};

/// Traces a valid ray to its nearest hit, or with kAnyHit to some hit. Any thread. begin: a t
/// before which the ray is known to hit nothing that counts.
template <bool kAnyHit>
FewFound trace_few(const BuiltScene& scene, const PreparedRay& p,
                   double begin = -std::numeric_limits<double>::infinity()) {
    FewTest<kAnyHit> few(scene, p);
    PreparedRay way = few.approach().ray();
    if (!few.approach().is_moved())
        way.ray.t_min = std::max(way.ray.t_min, begin);
    walk_scene(
        scene, way, [&](uint32_t number) { return few.test(number); },
        [&](double enter) { return few.limit(enter); });
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
