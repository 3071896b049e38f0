// SPDX-License-Identifier: Apache-2.0
// Tests which triangles are far, and that no tree leads to their pages.
#include "plugin/build/far_triangles.h"

#include "kdtree/test_soups.h"
#include "plugin/build/build_scene.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Returns n x n quads, 2 reach wide.
Chunk floor_of(int n, double reach, double height = 0) {
    return test::Floor{dvec3(0, 0, height), dvec3(reach, 0, 0), dvec3(0, reach, 0)}.chunk(n);
}

struct Found {
    size_t triangles;
    size_t portals;
};

/// Builds a scene of a grid of size 1 and these floors, and finds the far triangles.
template <class... Floors>
Found far_of(Floors... floors) {
    Soup soup = test::closed_grid(24);
    (soup.chunks.push_back(std::move(floors)), ...);
    const Result<BuiltScene> scene = build_scene(
        soup, {.leaf_triangles = 100},
        {.budget_bytes = 1 << 26, .batch_rays = 1024, .pool_bytes = 1 << 25}, {}, nullptr);
    EXPECT_TRUE(scene);
    for (const uint32_t leaf : scene->far.leaves)
        EXPECT_TRUE(scene->top.links_of(leaf).empty());
    EXPECT_EQ(scene->top.first_link.size(), scene->pages.size() + 1);
    return {scene->far.triangles.size(), scene->top.portals.size()};
}

TEST(FarTriangles, AreThoseOfALargeFloor) {
    const Found found = far_of(floor_of(1, 1e6));
    EXPECT_EQ(found.triangles, 2u);
    EXPECT_EQ(found.portals, 0u) << "all else shares a frame";
    EXPECT_EQ(far_of(floor_of(2, 1e6), floor_of(2, 1e6, 0.5)).triangles, 16u);
}

TEST(FarTriangles, AreFew) {
    EXPECT_LE(far_of(floor_of(20, 1e6)).triangles, 32u);
}

TEST(FarTriangles, AreNoneWhereOneFrameSuitsAll) {
    EXPECT_EQ(far_of(floor_of(1, 4)).triangles, 0u);
}

} // namespace
} // namespace ovc
