// SPDX-License-Identifier: Apache-2.0
// What two-level tells beside hits: statistics, the notes of a ray, the pages that rays went
// through.
#include "plugin/two_level/test_two_level.h"

#include <algorithm>

namespace ovc {
namespace {

using test::ok;

TEST_F(TwoLevelGl, CountsARayOnceByWhatItAsksFor) {
    const Soup soup = test::random_soup(9, 500, 0.3);
    const auto rays = test::rays_from_outside(3, 1000);
    const std::vector<uint32_t> masks(rays.size(), 1);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    std::vector<uint8_t> occluded(rays.size());
    Exclusions without;
    without.sieves.masks = masks;
    ASSERT_TRUE(ok(structure->occluded(rays, without, occluded)));
    EXPECT_EQ(structure->statistics().occlusion_rays, rays.size());
    EXPECT_EQ(structure->statistics().nearest_rays, 0u);
    std::vector<Hit> hits(3 * rays.size());
    std::vector<uint64_t> counts(rays.size());
    ASSERT_TRUE(ok(structure->all_hits(rays, {}, {3, hits, counts})));
    EXPECT_EQ(structure->statistics().nearest_rays, rays.size());
}

TEST_F(TwoLevelGl, TimeOfTheKernelIsPartOfThatOfPassesIsPartOfThatOfTheCall) {
    const Soup soup = test::closed_grid(100);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto rays = test::rays_from_outside(5, 100000);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_GT(structure->statistics().seconds_kernel, 0);
    EXPECT_LT(structure->statistics().seconds_kernel, structure->statistics().seconds_pass);
    EXPECT_LT(structure->statistics().seconds_pass, structure->statistics().seconds_trace);
}

TEST_F(TwoLevelGl, TellsTheLeafOfAHitAndThePassesOfARay) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const auto rays = test::rays_from_outside(12, 30000);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    for (const uint64_t budget : {uint64_t(0), all / 4}) {
        const auto structure = build(soup, {.budget_bytes = budget});
        ASSERT_TRUE(structure);
        std::vector<Hit> hits(rays.size());
        std::vector<uint32_t> leaf(rays.size()), passes(rays.size(), 7);
        ASSERT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {leaf, passes})));
        uint64_t visits = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            visits += passes[i];
            ASSERT_EQ(hits[i].is_hit(), leaf[i] != kNone) << "ray " << i;
            if (!hits[i].is_hit())
                continue;
            const Leaf& told = structure->scene().level1.leaves[leaf[i]];
            EXPECT_TRUE(std::ranges::binary_search(told.triangles, hits[i].id)) << "ray " << i;
            EXPECT_TRUE(told.cell.contains(rays[i].at(hits[i].t))) << "ray " << i;
            EXPECT_GE(passes[i], 1u) << "ray " << i;
        }
        EXPECT_EQ(visits, structure->statistics().ray_visits);
        EXPECT_EQ(structure->statistics().bytes_in > all * 11 / 10, budget > 0) << "moved again";
        const uint32_t most = *std::ranges::max_element(passes);
        EXPECT_EQ(most == 1, budget == 0) << most << " passes";
    }
}

TEST_F(TwoLevelGl, TellsWhichRaysTheKernelWasNotCertainOf) {
    const Soup soup = test::random_soup(8, 3000, 0.01);
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    auto rays = test::rays_from_outside(12, soup.triangle_count());
    for (uint32_t i = 0; i < rays.size(); i += 2) // at corners, where a hit is never certain
        rays[i].dir = soup.triangle({0, i})[0] - rays[i].org;
    std::vector<Hit> hits(rays.size());
    std::vector<uint32_t> flagged(rays.size(), 7);
    ASSERT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {{}, {}, flagged})));
    uint64_t at_corners = 0, elsewhere = 0;
    for (size_t i = 0; i < rays.size(); ++i)
        (i % 2 == 0 ? at_corners : elsewhere) += flagged[i];
    EXPECT_GT(at_corners, rays.size() / 4) << "but for those that something hides";
    EXPECT_LT(elsewhere, rays.size() / 50);
    EXPECT_EQ(at_corners + elsewhere, structure->statistics().flagged) << "once a ray, in one pass";
}

TEST_F(TwoLevelGl, TellsThePagesThatRaysWentThrough) {
    const Soup soup = test::random_soup(8, 60000, 0.01);
    const auto aimed = test::rays_from_outside(12, 5000);
    const std::vector<Ray> few(aimed.begin(), aimed.begin() + 3);
    const uint64_t all = build(soup, {})->scene().level2_bytes();
    for (const bool compute : {false, true})
        for (const uint64_t budget : {uint64_t(0), all / 4}) {
            const auto structure = build(
                soup,
                {.budget_bytes = budget, .leaves = 60, .compute = compute, .tell_active = true});
            ASSERT_TRUE(structure);
            const auto trace = [&](std::span<const Ray> rays) {
                std::vector<Hit> hits(rays.size());
                std::vector<uint32_t> leaf(rays.size());
                EXPECT_TRUE(ok(structure->intersect_noted(rays, {}, hits, {leaf, {}})));
                std::ranges::sort(leaf);
                const auto end = std::ranges::unique(leaf).begin();
                return size_t(end - leaf.begin()) - (leaf.back() == kNone); // leaves that were hit
            };
            const size_t hit = trace(aimed);
            const Result<ovc_active> active = structure->take_active();
            ASSERT_TRUE(active) << active.error().message;
            EXPECT_GE(active->pages, hit);
            EXPECT_LE(active->bytes, structure->scene().level2_bytes());
            EXPECT_EQ(active->pages, active->new_pages);
            // Fewer rays: no page is new.
            trace(few);
            const Result<ovc_active> less = structure->take_active();
            ASSERT_TRUE(less);
            EXPECT_GT(less->pages, 0u);
            EXPECT_LT(less->pages, active->pages);
            EXPECT_EQ(less->new_pages, 0u);
            EXPECT_EQ(structure->take_active()->pages, 0u) << "no rays since";
            EXPECT_EQ(structure->statistics().queues > 0, budget > 0);
            EXPECT_GE(structure->statistics().queued_rays, structure->statistics().longest_queue);
        }
    EXPECT_FALSE(build(soup, {})->take_active());
}

} // namespace
} // namespace ovc
