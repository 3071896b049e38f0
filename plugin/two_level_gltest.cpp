// SPDX-License-Identifier: Apache-2.0
// The twin rule: whatever the leaf size, the budget and the batch, two-level answers bit for bit
// what testing every triangle in double answers.
#include "plugin/two_level.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

class TwoLevelGl : public testing::Test {
protected:
    void SetUp() override {
        Result<std::unique_ptr<GlThread>> started = GlThread::start("", {});
        if (!started)
            GTEST_SKIP() << started.error().message;
        gl = std::move(*started);
    }

    std::unique_ptr<TwoLevel> build(const Soup& soup, const TwoLevelOptions& options) {
        Result<std::unique_ptr<TwoLevel>> built = TwoLevel::build(soup, *gl, options, {});
        EXPECT_TRUE(built) << built.error().message;
        return built ? std::move(*built) : nullptr;
    }

    std::unique_ptr<GlThread> gl;
};

testing::AssertionResult ok(const Result<Done>& result) {
    if (result)
        return testing::AssertionSuccess();
    return testing::AssertionFailure() << result.error().message;
}

struct Variant {
    std::string name;
    TwoLevelOptions options;
};

std::vector<Variant> variants() {
    return {{"ten leaves", {}},
            {"one leaf", {.leaf_triangles = 1u << 30}},
            {"leaves of 40", {.leaf_triangles = 40}},
            {"compute", {.leaf_triangles = 500, .compute = true}},
            {"smallest budget", {.budget_bytes = 64u << 10, .leaf_triangles = 100}}};
}

TEST_F(TwoLevelGl, EqualsBruteForceBitForBit) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        const auto rays = test::unpleasant_rays(soup, 33, 1500);
        std::vector<Hit> expected;
        for (const Ray& ray : rays)
            expected.push_back(test::brute_force(soup, ids, ray));
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(soup_name + ", " + name);
            const auto structure = build(soup, options);
            ASSERT_TRUE(structure);
            std::vector<Hit> hits(rays.size());
            std::vector<uint8_t> shadows(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            ASSERT_TRUE(ok(structure->occluded(rays, {}, shadows)));
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(test::same(expected[i], hits[i]))
                    << "ray " << i << ": " << test::describe(expected[i]) << " but found "
                    << test::describe(hits[i]);
                ASSERT_EQ(expected[i].is_hit(), shadows[i] != 0) << "ray " << i;
            }
            const TwoLevelStatistics& s = structure->statistics();
            EXPECT_LE(s.peak_bytes, structure->plan().budget_bytes);
            EXPECT_EQ(s.nearest_rays, rays.size());
        }
    }
}

TEST_F(TwoLevelGl, FewOrdinaryRaysAreFlagged) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    test::Random random(5);
    std::vector<Ray> rays(100000);
    for (Ray& ray : rays) {
        ray.org = random.point(-1, 1) + dvec3(0, 0, 4);
        ray.dir = random.point(-1, 1) - ray.org;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 100);
    EXPECT_GT(structure->statistics().passes, 0u);
}

TEST_F(TwoLevelGl, RaysThatStartOnASurfaceAreNotFlaggedForIt) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    test::Random random(6);
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    for (uint32_t prim = 0; prim < soup.triangle_count(); ++prim) {
        const Triangle t = soup.triangle({0, prim});
        const double u = random(0, 0.5), v = random(0, 0.5);
        rays.push_back({t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]), 0, random.point(-1, 1)});
        skip.push_back({0, prim});
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 50);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (size_t i = 0; i < rays.size(); i += 97)
        EXPECT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i], skip[i])));
}

TEST_F(TwoLevelGl, KeepsToTheBudgetByMovingPages) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const uint64_t all = build(soup, {})->statistics().level2_bytes;
    const auto rays = test::unpleasant_rays(soup, 12, 30000);
    const auto structure = build(soup, {.budget_bytes = all / 4});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    const TwoLevelStatistics& s = structure->statistics();
    EXPECT_LE(s.peak_bytes, all / 4);
    EXPECT_GT(s.pages_in, structure->level1().leaves.size()) << "nothing had to move twice";
    EXPECT_GE(s.bytes_in, s.level2_bytes);
}

TEST_F(TwoLevelGl, FastPrecisionIsCloseAndFlagsNothing) {
    const Soup soup = test::closed_grid(100);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (const bool compute : {false, true}) {
        const auto structure = build(soup, {.certify = false, .compute = compute});
        ASSERT_TRUE(structure);
        test::Random random(15);
        std::vector<Ray> rays(5000);
        for (Ray& ray : rays) {
            ray.org = random.point(-1, 1) + dvec3(0, 0, 4);
            ray.dir = random.point(-1, 1) - ray.org;
        }
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        size_t other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, ids, rays[i]);
            if (hits[i].id != expected.id) {
                ++other;
                continue;
            }
            if (!expected.is_hit())
                continue;
            EXPECT_NEAR(hits[i].t, expected.t, 1e-5);
            EXPECT_NEAR(hits[i].u, expected.u, 1e-2);
            EXPECT_NEAR(hits[i].v, expected.v, 1e-2);
        }
        EXPECT_LT(other, rays.size() / 500);
        EXPECT_EQ(structure->statistics().flagged, 0u);
    }
}

TEST_F(TwoLevelGl, NamesTheSmallestBudgetThatWorks) {
    const Soup soup = test::random_soup(8, 100, 0.01);
    const auto refused = TwoLevel::build(soup, *gl, {.budget_bytes = 1024}, {});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "a GPU budget of 1024 bytes is too small: the smallest that works is 65536 bytes "
              "(49152 for rays and answers, 16384 for a page)");
    EXPECT_TRUE(TwoLevel::build(soup, *gl, {.budget_bytes = 65536}, {}));
}

} // namespace
} // namespace ovc
