// SPDX-License-Identifier: Apache-2.0
// The stability suite in its short form: certified mode answers what double precision answers, and
// double precision answers what exact arithmetic answers, or would for a ray moved by its rounding.
#include "host/report/stability.h"

#include "host/report/stability_table.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"
#include "tests/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace ovc {
namespace {

std::vector<StabilityCase> all_cases() {
    Result<std::vector<StabilityCase>> cases = stability_cases(/* data= */ "");
    EXPECT_TRUE(cases);
    return std::move(*cases);
}

TEST(Stability, CertifiedIsDoubleAndLeaksNothing) {
    StabilityOptions options;
    const std::vector<StabilityCase> cases = all_cases();
    const auto results = run_stability(cases, options, {}, [](const StabilityResult&) {});
    if (!results)
        GTEST_SKIP() << results.error().message;
    std::fputs(stability_markdown(*results).c_str(), stdout);
    uint64_t flagged = 0;
    for (const StabilityResult& r : *results) {
        EXPECT_EQ(r.certified.wrong, 0u) << r.name;
        EXPECT_EQ(r.wrong_occlusions, 0u) << r.name;
        EXPECT_EQ(r.certified.leaks, 0u) << r.name;
        EXPECT_EQ(r.reference_leaks, 0u) << r.name;
        EXPECT_EQ(r.miscounted, 0u) << r.name;
        EXPECT_LE(r.time_ratio, 2.5) << r.name;
        EXPECT_LE(r.retraced, r.flagged) << r.name;
        flagged += r.flagged;
    }
    EXPECT_GT(flagged, 0u) << "vertices and edges are beyond float32";
}

/// What a difference between double and exact arithmetic comes to.
enum class Verdict { Equal, Tie, Rounding, Wrong };

/// Eight roundings: of the shear, of a corner relative to the origin, of its product with the
/// shear, of the sum.
constexpr double kRounding = 0x1p-50;

/// Exact arithmetic on the triangles of one soup that a ray sees.
class ExactJudge {
public:
    explicit ExactJudge(const Soup& soup)
        : soup_(soup), ids_(hittable_triangles(soup, nullptr, nullptr)) {}

    Verdict judge(const Ray& ray, TriangleId skip, const Hit& answer) const {
        const TriangleId truth = nearest(ray, skip);
        if (answer.id == truth)
            return Verdict::Equal;
        if (answer.is_hit() && truth.mesh != kNone &&
            test::exact_hit(ray, soup_.triangle(answer.id)) ==
                test::exact_hit(ray, soup_.triangle(truth)))
            return Verdict::Tie;
        if (answer.is_hit() && plausible(ray, skip, answer))
            return Verdict::Rounding;
        for (const TriangleId id : {answer.id, truth})
            if (id.mesh != kNone && within_rounding(ray, skip, answer.id, reach(ray, id)))
                return Verdict::Rounding;
        return Verdict::Wrong;
    }

private:
    TriangleId nearest(const Ray& ray, TriangleId skip) const {
        if (!ray.valid())
            return {};
        std::vector<TriangleId> seen = ids_;
        std::erase(seen, skip);
        const auto hit = test::exact_nearest(soup_, seen, ray);
        return hit ? hit->id : TriangleId{};
    }

    /// How far the triangle's corners are from the ray's origin: what their rounding is relative
    /// to.
    double reach(const Ray& ray, TriangleId id) const {
        double most = 0;
        for (const dvec3& corner : soup_.triangle(id))
            most = std::max(most, max_component(glm::abs(corner - ray.org)));
        return most;
    }

    /// True when the triangles, moved together by no more than kRounding of the reach, would have
    /// the ray meet the answer's where double says it does, and nothing before it by more than
    /// that. For triangles smaller than the rounding of the distance they are seen from.
    bool plausible(const Ray& ray, TriangleId skip, const Hit& answer) const {
        const Triangle triangle = soup_.triangle(answer.id);
        const dvec3 weights = glm::mix(dvec3(1 - answer.u - answer.v, answer.u, answer.v),
                                       dvec3(1.0 / 3), /* off the edges by */ 0.01);
        const double slack = kRounding * reach(ray, answer.id);
        const dvec3 shift = exact_gap(ray, answer.t, triangle, weights);
        if (max_component(glm::abs(shift)) > slack)
            return false;
        const auto moved = [&](TriangleId id) {
            Triangle t = soup_.triangle(id);
            for (dvec3& corner : t)
                corner += shift;
            return t;
        };
        const auto t = test::exact_hit(ray, moved(answer.id));
        if (!t)
            return false;
        const test::Rational least =
            *t - test::Rational(slack) / test::Rational(max_component(glm::abs(ray.dir)));
        return std::none_of(ids_.begin(), ids_.end(), [&](TriangleId id) {
            if (id == skip || !test::near(ray, soup_.triangle(id)))
                return false;
            const auto other = test::exact_hit(ray, moved(id));
            return other && *other < least;
        });
    }

    /// From the weighted corners to the ray's point at t, rounded once.
    static dvec3 exact_gap(const Ray& ray, double t, const Triangle& triangle, dvec3 weights) {
        dvec3 gap;
        for (int axis = 0; axis < 3; ++axis) {
            test::Rational sum =
                test::Rational(ray.org[axis]) + test::Rational(t) * test::Rational(ray.dir[axis]);
            for (int corner = 0; corner < 3; ++corner)
                sum -= test::Rational(weights[corner]) *
                       test::Rational(triangle[size_t(corner)][axis]);
            gap[axis] = double(sum);
        }
        return gap;
    }

    /// True when the answer is exact for a ray whose origin is off by kRounding of `reach`, or its
    /// direction by kRounding of its largest component, or its range by kRounding of itself.
    bool within_rounding(const Ray& ray, TriangleId skip, TriangleId answer, double reach) const {
        const double length = max_component(glm::abs(ray.dir));
        for (const double range : {0.0, -kRounding, kRounding})
            for (int way = 0; way < 27; ++way) {
                const dvec3 step = kRounding * dvec3(way % 3 - 1, way / 3 % 3 - 1, way / 9 - 1);
                Ray moved = ray, turned = ray;
                moved.org += step * reach;
                turned.dir += step * length;
                moved.t_min = turned.t_min = ray.t_min * (1 - range);
                moved.t_max = turned.t_max = ray.t_max * (1 + range);
                if (nearest(moved, skip) == answer || nearest(turned, skip) == answer)
                    return true;
            }
        return false;
    }

    const Soup& soup_;
    std::vector<TriangleId> ids_;
};

std::string name_of(TriangleId id) {
    return id.mesh == kNone ? "miss" : std::to_string(id.mesh) + "/" + std::to_string(id.prim);
}

void compare_with_exact(const StabilityCase& one) {
    const Soup soup = one.soup();
    const KdTree tree = build_kd_tree(soup);
    // A ray costs a box test for every triangle, and exact numbers for every one that it comes
    // near.
    const size_t sample = std::clamp<size_t>(200'000 / soup.triangle_count(), 8, 40);
    const RaySet set = stability_rays(one, soup, 0, sample);
    const ExactJudge judge(soup);
    size_t counts[4] = {};
    for (size_t i = 0; i < sample; ++i) {
        const TriangleId skip = set.skip.empty() ? TriangleId{} : set.skip[i];
        const Hit answer = intersect(tree, soup, set.rays[i], skip);
        const Verdict verdict = judge.judge(set.rays[i], skip, answer);
        ++counts[size_t(verdict)];
        if (verdict == Verdict::Wrong)
            std::printf("%s: ray %zu: double %s at %.17g: no nearby ray has this exact answer\n",
                        one.name.c_str(), i, name_of(answer.id).c_str(), answer.t);
    }
    std::printf("%-45s %3zu rays: %3zu exact, %2zu ties, %2zu within rounding, %zu wrong\n",
                one.name.c_str(), sample, counts[0], counts[1], counts[2], counts[3]);
    EXPECT_EQ(counts[size_t(Verdict::Wrong)], 0u) << one.name;
}

TEST(Stability, DoubleIsExactUpToRounding) {
    for (const StabilityCase& one : all_cases())
        compare_with_exact(one);
}

} // namespace
} // namespace ovc
