// SPDX-License-Identifier: Apache-2.0
// Runs the stability suite in its short form: certified mode answers as the reference does, and the
// reference names the same triangle as exact arithmetic.
#include "host/suites/stability/stability.h"

#include "host/suites/stability/stability_table.h"
#include "kdtree/build.h"
#include "kdtree/traverse.h"
#include "tests/exact.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>

namespace ovc {
namespace {

std::vector<StabilityCase> all_cases() {
    return stability_cases(/* dragon= */ nullptr);
}

double within_of(std::span<const StabilityCase> cases, const std::string& name) {
    return std::ranges::find(cases, name, &StabilityCase::name)->within;
}

TEST(Stability, CertifiedIsTheReferenceAndLeaksNothing) {
    StabilityOptions options;
    options.peers = false; // nothing is expected of them
    const std::vector<StabilityCase> cases = all_cases();
    const auto results = run_stability(cases, options, {}, [](const StabilityResult&) {});
    if (!results)
        GTEST_SKIP() << results.error().message;
    std::fputs(stability_markdown("Numerical stability", *results).c_str(), stdout);
    uint64_t flagged = 0;
    for (const StabilityResult& r : *results) {
        EXPECT_EQ(r.certified.wrong, 0u) << r.name;
        EXPECT_EQ(r.wrong_occlusions, 0u) << r.name;
        EXPECT_EQ(r.certified.leaks, 0u) << r.name;
        EXPECT_EQ(r.reference_leaks, 0u) << r.name;
        EXPECT_EQ(r.miscounted, 0u) << r.name;
        EXPECT_LE(r.time_ratio, within_of(cases, r.name)) << r.name;
        EXPECT_LE(r.retraced, r.flagged) << r.name;
        flagged += r.flagged;
    }
    EXPECT_GT(flagged, 0u) << "vertices and edges are beyond float32";
}

std::string name_of(TriangleId id) {
    return id.mesh == kNone ? "miss" : std::to_string(id.mesh) + "/" + std::to_string(id.prim);
}

/// Returns the exact nearest hit among the triangles that the ray sees. Of equal t, the smaller id
/// wins.
TriangleId exact_answer(const Soup& soup, std::vector<TriangleId> seen, const Ray& ray,
                        TriangleId skip) {
    if (!ray.valid())
        return {};
    std::erase(seen, skip);
    const auto hit = test::exact_nearest(soup, seen, ray);
    return hit ? hit->id : TriangleId{};
}

void compare_with_exact(const StabilityCase& one) {
    const Soup soup = one.soup();
    const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, nullptr);
    const KdTree tree = build_kd_tree(soup);
    // A ray costs a box test for every triangle, and exact arithmetic for every triangle nearby.
    const size_t sample = std::clamp<size_t>(120'000 / soup.triangle_count(), 8, 60);
    const AimedRays set = stability_rays(one, soup, 0, sample);
    size_t wrong = 0;
    for (size_t i = 0; i < sample; ++i) {
        const TriangleId skip = set.skip.empty() ? TriangleId{} : set.skip[i];
        const Hit answer = intersect(tree, soup, set.rays[i], skip);
        const TriangleId exact = exact_answer(soup, ids, set.rays[i], skip);
        wrong += answer.id != exact;
        EXPECT_EQ(answer.id, exact)
            << one.name << ": ray " << i << ": the reference says " << name_of(answer.id) << " at "
            << answer.t << ", exact arithmetic " << name_of(exact);
    }
    std::printf("%-40s %3zu rays, %zu not exact\n", one.name.c_str(), sample, wrong);
}

TEST(Stability, TheReferenceIsExact) {
    for (const StabilityCase& one : all_cases())
        compare_with_exact(one);
}

} // namespace
} // namespace ovc
