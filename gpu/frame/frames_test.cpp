// SPDX-License-Identifier: Apache-2.0
// Checks that a frame is rejected if triangles are too small in it for float32.
#include "gpu/frame/frames.h"

#include "kdtree/build.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <utility>

namespace ovc {
namespace {

double share_of(const Soup& soup) {
    Box bounds;
    const auto triangles = hittable_triangles(soup, nullptr, &bounds);
    return doubtful_share(soup, triangles, scene_leaf(bounds).frame);
}

TEST(DoubtfulShare, GrowsAsTrianglesShrinkInTheFrame) {
    const double coarse = share_of(test::closed_grid(16));
    EXPECT_GT(coarse, 0);
    EXPECT_NEAR(share_of(test::closed_grid(32)) / coarse, 2, 0.2);

    EXPECT_LT(share_of(test::closed_grid(32)), kMaxDoubtful);
    EXPECT_GT(share_of(test::random_soup(3, 1000, 1e-7)), kMaxDoubtful);
}

Soup together(Soup soup, Soup more) {
    soup.chunks.push_back(std::move(more.chunks.front()));
    return soup;
}

TEST(DoubtfulShare, LeavesSmallTrianglesToLargeOnesBesideThem) {
    const auto small = [] { return test::random_soup(3, 3000, 1e-5); };
    const double alone = share_of(small());
    EXPECT_GT(alone, 0.01);
    EXPECT_LT(share_of(together(small(), test::random_soup(4, 3000, 0.1))), alone / 100)
        << "rays seldom hit the small ones";
}

TEST(DoubtfulShare, ATriangleThatReachesFarDoesNotHideThoseInOneSpot) {
    Soup ground = test::one_chunk({{-1e6, -1e6, 0}, {1e6, -1e6, 0}, {0, 1e6, 0}});
    EXPECT_GT(share_of(together(test::closed_grid(32), std::move(ground))), kMaxDoubtful);
}

} // namespace
} // namespace ovc
