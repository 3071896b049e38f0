// SPDX-License-Identifier: Apache-2.0
// Batches that the CPU answers: with the bits of the kernel's answers, and which are left to it.
#include "plugin/two_level/test_two_level.h"

#include <cstring>

namespace ovc {
namespace {

using test::ok;

bool takes(const TwoLevel& structure, const std::vector<Ray>& rays) {
    std::vector<Hit> hits(rays.size());
    uint64_t invalid = 0;
    return structure.intersect_few(rays, {}, hits, invalid);
}

TEST_F(TwoLevelGl, AnswersSmallBatchesOnTheCpuAsTheKernelDoes) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        if (soup.triangle_count() == 0)
            continue; // it has no pages that could be resident
        const auto structure = build(soup, {});
        ASSERT_TRUE(structure);
        std::vector<Ray> rays = test::unpleasant_rays(soup, 17, 1500);
        rays[700].dir = dvec3(0);
        std::vector<Hit> hits(rays.size()), on_cpu(rays.size());
        std::vector<uint8_t> occluded(rays.size()), occluded_on_cpu(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        ASSERT_TRUE(ok(structure->occluded(rays, {}, occluded)));
        const uint64_t invalid = structure->statistics().invalid_rays / 2;
        uint64_t invalid_on_cpu = 0;
        ASSERT_TRUE(structure->intersect_few(rays, {}, on_cpu, invalid_on_cpu));
        EXPECT_EQ(invalid_on_cpu, invalid);
        ASSERT_TRUE(structure->occluded_few(rays, {}, occluded_on_cpu, invalid_on_cpu));
        EXPECT_EQ(invalid_on_cpu, 2 * invalid);
        EXPECT_EQ(std::memcmp(on_cpu.data(), hits.data(), hits.size() * sizeof(Hit)), 0);
        EXPECT_EQ(occluded_on_cpu, occluded);
    }
}

TEST_F(TwoLevelGl, LeavesSmallBatchesToTheKernelWherePagesMoveOrItIsNamed) {
    const Soup soup = test::random_soup(8, 3000, 0.01);
    const auto rays = test::rays_from_outside(12, 1000);
    const std::vector<Ray> few(rays.begin(), rays.begin() + kMaxFewRays);
    std::vector<Hit> hits(rays.size());
    const auto takes_both = [&](const TwoLevelOptions& options) {
        const auto structure = build(soup, options);
        EXPECT_TRUE(takes(*structure, few));
        EXPECT_FALSE(takes(*structure, rays)) << "before any call the pages are nowhere";
        EXPECT_TRUE(ok(structure->intersect(rays, {}, hits)));
        return takes(*structure, rays);
    };
    EXPECT_TRUE(takes_both({}));
    EXPECT_FALSE(takes_both({.kernel_alone = true}));
    EXPECT_FALSE(takes_both({.budget_bytes = 96u << 10, .leaf_triangles = 100}));
}

} // namespace
} // namespace ovc
