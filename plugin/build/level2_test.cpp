// SPDX-License-Identifier: Apache-2.0
// Tests how many leaves there are where the caller leaves that open, and the sizes of pages.
#include "plugin/build/level2.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

struct Built {
    size_t leaves;
    uint64_t bytes;
};

Built build(const Soup& soup, const LeafLimits& limits) {
    BuiltScene scene(soup);
    scene.limits = limits;
    EXPECT_TRUE(build_levels(scene, take_hittable(scene)));
    return {scene.pages.size(), scene.level2_bytes()};
}

TEST(LevelsOf, ASceneThatFitsAreOneLeafWherePlanesWouldCutMuch) {
    const Soup soup = test::random_soup(3, 8000, 0.2);
    const uint64_t tenth = soup.triangle_count() / 10;
    const Built one = build(soup, {tenth, 1 << 30, LeafLimits::kAny});
    EXPECT_EQ(one.leaves, 1u);
    EXPECT_EQ(build(soup, {tenth, 1 << 30, one.bytes * 5 / 4}).leaves, 1u);
    const size_t leaves = build(soup, {tenth, 1 << 30, 0}).leaves;
    EXPECT_GT(leaves, 9u);
    EXPECT_EQ(build(soup, {tenth, 1 << 30, one.bytes / 2}).leaves, leaves);
}

TEST(LevelsOf, AMeshThatFitsAreLeavesBuiltSideBySide) {
    const Soup soup = test::closed_grid(250);
    EXPECT_GT(build(soup, {soup.triangle_count() / 10, 1 << 30, LeafLimits::kAny}).leaves, 9u);
}

TEST(LevelsOf, ASceneThatSeemedToFitAreLeavesWithinTheirPages) {
    const Soup soup = test::random_soup(3, 8000, 0.2);
    const uint64_t bytes = build(soup, {1 << 20, 1 << 30, LeafLimits::kAny}).bytes;
    // The estimate by cubes may be a few percent below the size of the page.
    for (const double share : {0.97, 0.99, 1.0, 1.03, 1.06}) {
        const uint64_t whole = uint64_t(share * double(bytes));
        const Built built = build(soup, {soup.triangle_count() / 10, bytes / 3, whole});
        EXPECT_TRUE(built.leaves == 1 ? built.bytes <= whole : built.leaves > 2) << share;
    }
}

TEST(LevelsOf, ASceneWhoseTrianglesAreLostInItsFrameAreLeaves) {
    Soup soup = test::random_soup(3, 8000, 0.2);
    std::vector<vec3> corners(3, vec3(0));
    corners[1].x = corners[2].y = 1;
    soup.chunks.push_back(Chunk::owning(dvec3(1e6), std::move(corners)));
    EXPECT_GT(build(soup, {soup.triangle_count() / 10, 1 << 30, LeafLimits::kAny}).leaves, 9u);
}

} // namespace
} // namespace ovc
