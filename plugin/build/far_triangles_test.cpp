// SPDX-License-Identifier: Apache-2.0
// Which triangles are far, and that no tree leads to their pages.
#include "plugin/build/far_triangles.h"

#include "kdtree/test_soups.h"
#include "plugin/build/build_scene.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// n x n quads, 2 reach wide.
struct Square {
    int n;
    double reach;
    double height = 0;
};

Chunk chunk_of(const Square& square) {
    const int n = square.n;
    const auto along = [&](int i) { return square.reach * (2.0 * i / n - 1); };
    const auto at = [&](int i, int j) { return dvec3(along(i), along(j), square.height); };
    std::vector<dvec3> corners;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
            corners.insert(corners.end(), {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j),
                                           at(i + 1, j + 1), at(i, j + 1)});
    return Chunk::owning_doubles(dvec3(0), std::move(corners));
}

struct Found {
    size_t triangles;
    size_t portals;
};

/// Builds a scene of a grid of size 1 and these squares, and finds the far triangles.
Found far_of(const std::vector<Square>& squares) {
    Soup soup = test::closed_grid(24);
    for (const Square& square : squares)
        soup.chunks.push_back(chunk_of(square));
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
    const Found found = far_of({{1, 1e6}});
    EXPECT_EQ(found.triangles, 2u);
    EXPECT_EQ(found.portals, 0u) << "all else shares a frame";
    EXPECT_EQ(far_of({{2, 1e6}, {2, 1e6, 0.5}}).triangles, 16u);
}

TEST(FarTriangles, AreFew) {
    EXPECT_LE(far_of({{20, 1e6}}).triangles, 32u);
}

TEST(FarTriangles, AreNoneWhereOneFrameSuitsAll) {
    EXPECT_EQ(far_of({{1, 4}}).triangles, 0u);
}

} // namespace
} // namespace ovc
