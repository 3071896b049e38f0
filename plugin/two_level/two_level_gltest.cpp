// SPDX-License-Identifier: Apache-2.0
// The rule of equal answers: whatever the leaf size, the budget and the batch, two-level answers
// bit for bit what testing every triangle in double answers.
#include "plugin/two_level/test_two_level.h"

#include "core/text/format_text.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace ovc {
namespace {

using test::ok;

TEST_F(TwoLevelGl, EqualsBruteForceBitForBit) {
    for (const auto& [soup_name, soup] : test::unpleasant_soups()) {
        const auto rays = test::unpleasant_rays(soup, 33, 1500);
        const std::vector<Hit> expected = test::brute_force(soup, rays);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(soup_name + ", " + name);
            const auto structure = build(soup, options);
            ASSERT_TRUE(structure);
            test::expect_answers(*structure, rays, expected);
            const ovc_statistics& s = structure->statistics();
            EXPECT_LE(s.gpu_peak_bytes, structure->plan().budget_bytes);
            EXPECT_EQ(s.nearest_rays, rays.size());
        }
    }
}

/// Every coordinate of these rays is exact at the corner, and none is along the way.
TEST_F(TwoLevelGl, ARayFromFarAwayMeetsTheCornerOfTheScene) {
    const Soup soup = test::one_chunk({vec3(0), vec3(1, 0, 0), vec3(0, 1, 0)});
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    test::Random random(1);
    std::vector<Ray> rays(3000);
    for (Ray& ray : rays) {
        ray.dir = glm::floor(random.point(1, 50)) * dvec3(1, 1, -1);
        ray.org = -std::floor(random(1e8, 1e9)) * ray.dir;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        EXPECT_TRUE(hits[i].is_hit()) << "ray " << i;
}

TEST_F(TwoLevelGl, AFloorLiesInALeafOfItsOwn) {
    const Soup soup = test::grid_on_floor(24);
    const auto unpleasant = test::unpleasant_rays(soup, 34, 3000);
    const std::vector<Hit> expected = test::brute_force(soup, unpleasant);
    const auto rays = test::rays_from_outside(35, 3000);
    const std::vector<Hit> ordinary = test::brute_force(soup, rays);
    for (const uint64_t budget : {0u, 112u << 10})
        for (const bool certify : {true, false}) {
            const auto structure =
                build(soup, {.budget_bytes = budget, .leaf_triangles = 60, .certify = certify});
            ASSERT_TRUE(structure);
            EXPECT_EQ(structure->scene().level1.far_leaves, 1u);
            if (certify) {
                test::expect_answers(*structure, unpleasant, expected);
                continue;
            }
            std::vector<Hit> hits(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            size_t other = 0;
            for (size_t i = 0; i < rays.size(); ++i)
                other += hits[i].id != ordinary[i].id;
            EXPECT_LT(other, rays.size() / 500);
        }
}

/// The pool holds all pages, or all but the top-level tree beside them, or all but one.
TEST_F(TwoLevelGl, AnyBudgetNearThatOfAllPagesAnswersAlike) {
    const Soup soup = test::closed_grid(60);
    const std::vector<Ray> rays = test::rays_from_outside(13, 4000);
    const auto all = build(soup, {.leaf_triangles = 100});
    ASSERT_TRUE(all);
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    ASSERT_TRUE(ok(all->intersect(rays, {}, expected)));
    const uint64_t pages = all->scene().level2_bytes();
    size_t waited = 0, resident = 0; // structures whose rays waited for pages, or did not
    for (uint64_t pool = pages - (16 << 10); pool < pages + (128 << 10); pool += 8 << 10) {
        const uint64_t budget = pool / 7 * 8; // an eighth is for rays
        const auto structure = build(soup, {.budget_bytes = budget, .leaf_triangles = 100});
        ASSERT_TRUE(structure);
        for (int call = 0; call < 3; ++call) { // pages move in the first
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            for (size_t i = 0; i < rays.size(); ++i)
                ASSERT_TRUE(test::same(hits[i], expected[i])) << "ray " << i << ", pool " << pool;
        }
        const ovc_statistics told = structure->report();
        ++(told.queues + told.stragglers > 0 ? waited : resident);
    }
    EXPECT_GT(waited, 0u);
    EXPECT_GT(resident, 0u);
}

/// Keeps the share of the rays that it was told last.
struct Listens final : TraceWatch {
    double told = 0;
    bool goes_on(double done) override {
        told = done;
        return true;
    }
};

/// There are so many rays that they come in several parts, one of which has no ray for the kernel.
/// So many that 32 bits do not number them all are as those of which 17 bits do not.
TEST_F(TwoLevelGl, ManyRaysAreAnsweredAsFewAre) {
    const Soup soup = test::closed_grid(60);
    std::vector<Ray> rays = test::rays_from_outside(11, 300000);
    test::Random random(12);
    for (Ray& ray : rays)
        if (random.below(5) == 0)
            ray.dir = -ray.dir; // away from the scene
    for (size_t i = 70000; i < 230000; ++i)
        rays[i].t_max = -1; // invalid
    const auto linked = build(soup, {}), numbered = build(soup, {.max_numbered_rays = 1u << 17});
    const auto moving = build(soup, {.budget_bytes = 192u << 10, .leaf_triangles = 300});
    ASSERT_TRUE(linked && numbered && moving);
    std::vector<Hit> expected(rays.size());
    ASSERT_TRUE(ok(moving->intersect(rays, {}, expected)));
    for (TwoLevel* all : {linked.get(), numbered.get()}) {
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(all->intersect(rays, {}, hits)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_TRUE(test::same(hits[i], expected[i])) << "ray " << i;
        EXPECT_GT(all->statistics().passes, 1u);
        EXPECT_EQ(all->statistics().pages_in, all->scene().level1.leaves.size());
        EXPECT_EQ(all->statistics().invalid_rays, 160000u);
        EXPECT_LT(all->statistics().ray_visits, 140000u);

        std::vector<uint8_t> occluded(rays.size());
        ASSERT_TRUE(ok(all->occluded(rays, {}, occluded)));
        for (size_t i = 0; i < rays.size(); ++i)
            ASSERT_EQ(occluded[i] != 0, expected[i].is_hit()) << "ray " << i;
    }
    EXPECT_GT(moving->statistics().pages_in, moving->scene().level1.leaves.size());
    Listens watch;
    const CallWatch::Scope scope(numbered->call_watch(), &watch);
    ASSERT_TRUE(ok(numbered->intersect(rays, {}, expected)));
    EXPECT_GT(watch.told, 0.8) << "of all rays, before the last pass of the third part";
}

/// The compute kernel takes neighbours together where they go the same way, and others in turns.
TEST_F(TwoLevelGl, RaysAreAnsweredAlikeInAnyOrderAndByBothKernels) {
    const Soup soup = test::closed_grid(60);
    constexpr int kSide = 300;
    std::vector<Ray> ordered;
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x)
            ordered.push_back({dvec3(0.1, 0.2, -4), 0, dvec3(x - kSide / 2, y - kSide / 2, 200)});
    std::vector<size_t> shuffled(ordered.size());
    std::iota(shuffled.begin(), shuffled.end(), size_t(0));
    std::shuffle(shuffled.begin(), shuffled.end(), std::mt19937(5));
    std::vector<Ray> rays;
    for (const size_t i : shuffled)
        rays.push_back(ordered[i]);

    const auto fragment = build(soup, {.compute = false});
    const auto compute = build(soup, {.compute = true});
    ASSERT_TRUE(fragment && compute);
    std::vector<Hit> expected(rays.size()), together(rays.size()), in_turns(rays.size());
    ASSERT_TRUE(ok(fragment->intersect(ordered, {}, expected)));
    ASSERT_TRUE(ok(compute->intersect(ordered, {}, together)));
    ASSERT_TRUE(ok(compute->intersect(rays, {}, in_turns)));
    std::vector<uint8_t> occluded(rays.size());
    ASSERT_TRUE(ok(compute->occluded(rays, {}, occluded)));
    size_t hit = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(test::same(expected[i], together[i])) << "ray " << i;
        ASSERT_TRUE(test::same(expected[shuffled[i]], in_turns[i])) << "ray " << shuffled[i];
        ASSERT_EQ(occluded[i] != 0, in_turns[i].is_hit()) << "ray " << shuffled[i];
        hit += in_turns[i].is_hit();
    }
    EXPECT_GT(hit, rays.size() / 10);
    EXPECT_LT(hit, rays.size());
}

TEST_F(TwoLevelGl, FewOrdinaryRaysAreFlagged) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto rays = test::rays_from_outside(5, 100000);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 100);
    EXPECT_GT(structure->statistics().passes, 0u);
}

TEST_F(TwoLevelGl, RaysThatStartOnASurfaceAreNotFlaggedForIt) {
    const Soup soup = test::closed_grid(200);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto [rays, skip] = test::RaysOnTriangles(soup, 1);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 50);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (size_t i = 0; i < rays.size(); i += 97)
        EXPECT_TRUE(test::same(hits[i], test::brute_force(soup, ids, rays[i], skip[i])));
}

TEST_F(TwoLevelGl, InvalidRaysMissBehindAnyPlace) {
    const Soup soup = test::random_soup(8, 300, 0.3);
    auto rays = test::rays_from_outside(57, 300);
    std::vector<Hit> hits(rays.size());
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    const double worst[] = {std::numeric_limits<double>::quiet_NaN(),
                            std::numeric_limits<double>::infinity(), -HUGE_VAL};
    for (size_t i = 0; i < rays.size(); ++i)
        (i % 2 ? rays[i].org : rays[i].dir)[int(i % 3)] = worst[i / 6 % 3];
    const std::vector<Hit> after = hits;
    ASSERT_TRUE(ok(structure->intersect(rays, Exclusions({}, after), hits)));
    EXPECT_FALSE(std::ranges::any_of(hits, &Hit::is_hit));
    EXPECT_EQ(structure->statistics().invalid_rays, rays.size());
}

TEST_F(TwoLevelGl, PassesByManyHitsInOnePointAtOnce) {
    test::Random random(58);
    std::vector<vec3> corners;
    for (int i = 0; i < 3000; ++i)
        for (const vec3& v : {vec3(-2, -2, 0), vec3(2, -2, 0), vec3(0, 2, 0)})
            corners.push_back(v * float(random(1, 2)));
    Soup soup = test::one_chunk(std::move(corners));
    soup.chunks.push_back(Chunk::owning({0, 0, -1}, {{-2, -2, 0}, {2, -2, 0}, {0, 2, 0}}));
    soup.chunks[0].set_mask(1);
    soup.chunks[1].set_mask(2);
    for (const size_t count : {size_t(1), size_t(200)}) {
        const auto structure = build(soup, {});
        ASSERT_TRUE(structure);
        std::vector<Ray> rays(count);
        for (Ray& ray : rays)
            ray = {{random(-0.1, 0.1), random(-0.1, 0.1), 1}, 0, {0, 0, -1}};
        const std::vector<uint32_t> masks(count, 2);
        Exclusions without;
        without.sieves.masks = masks;
        std::vector<Hit> hits(count);
        ASSERT_TRUE(ok(structure->intersect(rays, without, hits)));
        for (size_t i = 0; i < count; ++i) {
            EXPECT_EQ(hits[i].id, (TriangleId{1, 0})) << "ray " << i;
            const Hit one = structure->nearest_on_cpu(rays[i], {}, without.sieves[i]);
            EXPECT_TRUE(test::same(one, hits[i])) << "ray " << i;
        }
        const ovc_statistics& told = structure->statistics();
        EXPECT_LT(told.ray_visits + told.stragglers, 50 * count) << "each hit took a step";
    }
}

TEST_F(TwoLevelGl, KeepsToTheBudgetByMovingPages) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    const auto rays = test::unpleasant_rays(soup, 12, 30000);
    const auto structure = build(soup, {.budget_bytes = all / 4});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    const ovc_statistics& s = structure->statistics();
    EXPECT_LE(s.gpu_peak_bytes, all / 4);
    EXPECT_GT(s.pages_in, structure->scene().level1.leaves.size()) << "nothing had to move twice";
    EXPECT_GE(s.bytes_in, structure->scene().level2_bytes());
}

TEST_F(TwoLevelGl, NamesTheSmallestBudgetThatWorks) {
    const Soup soup = test::random_soup(8, 100, 0.01);
    const auto refused = TwoLevel::build(soup, *gl, {.budget_bytes = 1024}, {});
    ASSERT_FALSE(refused);
    const uint64_t passes = gl->info().passes_in_flight; // with rays and answers of their own
    EXPECT_EQ(refused.error().message,
              format_text("a GPU budget of 1024 bytes is too small: the smallest that works is {} "
                          "bytes ({} for rays and answers, 16384 for a page)",
                          passes * 24580 + 16384, passes * 24580));
    EXPECT_TRUE(TwoLevel::build(soup, *gl, {.budget_bytes = 81920}, {}));
}

} // namespace
} // namespace ovc
