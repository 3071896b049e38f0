// SPDX-License-Identifier: Apache-2.0
// Clipped bounds hold every point of the triangle inside the box.
#include "kdtree/clip.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(Clip, HoldsEveryPointOfTheTriangleInTheBox) {
    test::Random random(11);
    for (int round = 0; round < 2000; ++round) {
        const Triangle t{random.point(-1, 1), random.point(-1, 1), random.point(-1, 1)};
        Box box;
        box.add(random.point(-1, 1));
        box.add(random.point(-1, 1));
        const Box clipped = clipped_bounds(t, box);
        for (int i = 0; i < 50; ++i) {
            const double u = random(0, 1);
            const double v = random(0, 1 - u);
            const dvec3 p = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
            if (box.contains(p)) {
                ASSERT_TRUE(clipped.padded(1e-14).contains(p)) << "round " << round;
            }
        }
    }
}

TEST(Clip, IsEmptyWhenApartAndWholeWhenInside) {
    const Triangle t{dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)};
    EXPECT_TRUE(clipped_bounds(t, {dvec3(2), dvec3(3)}).empty());
    // The corner of the box is inside the triangle's bounds, but beyond its long side.
    EXPECT_TRUE(clipped_bounds(t, {dvec3(0.8, 0.8, -1), dvec3(2, 2, 1)}).empty());
    const Box whole = clipped_bounds(t, {dvec3(-5), dvec3(5)});
    EXPECT_EQ(whole.lo, dvec3(0));
    EXPECT_EQ(whole.hi, dvec3(1, 1, 0));
}

TEST(Clip, KeepsWhatOnlyTouches) {
    const Triangle t{dvec3(0), dvec3(1, 0, 0), dvec3(0, 1, 0)};
    EXPECT_FALSE(clipped_bounds(t, {dvec3(-1, -1, 0), dvec3(2, 2, 1)}).empty());
    EXPECT_FALSE(clipped_bounds(t, {dvec3(1, 0, 0), dvec3(2, 2, 1)}).empty());
}

} // namespace
} // namespace ovc
