// SPDX-License-Identifier: Apache-2.0
// The table of portals says what the portals are.
#include "gpu/frame/portal.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

/// Returns the float that these bits are.
double float_of(uint32_t bits) {
    return std::bit_cast<float>(bits);
}

// Kernels read boxes in floats. If a box were smaller than the part behind the portal, rays would
// pass by what lies at its sides.
TEST(Portal, HasTheSmallestBoxOfFloatsAroundItsPart) {
    test::Random random(3);
    for (int i = 0; i < 1000; ++i) {
        const dvec3 a = random.point(-1, 1), b = random.point(-1, 1);
        const Box box{glm::min(a, b), glm::max(a, b)};
        const Frame frame{.origin = random.point(-1, 1), .scale = std::ldexp(1.0, i % 7 - 3)};
        Portal portal = portal_into(frame, box);
        portal.tree = 5;
        portal.first_number = 7;
        const std::vector<uvec4> table = pack_portals({&portal, 1});
        ASSERT_EQ(table.size(), size_t(OVC_PORTAL_TEXELS));
        const uvec4 &g = table[6], &h = table[7];
        const dvec3 lo(float_of(g.x), float_of(g.y), float_of(g.z));
        const dvec3 hi(float_of(g.w), float_of(h.x), float_of(h.y));
        EXPECT_EQ(lo, portal.box.lo);
        EXPECT_EQ(hi, portal.box.hi);
        EXPECT_EQ(h.z, 5u);
        EXPECT_EQ(h.w, 7u);
        const dvec3 part_lo = frame.to_local(box.lo), part_hi = frame.to_local(box.hi);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(lo[axis], part_lo[axis]);
            EXPECT_GE(hi[axis], part_hi[axis]);
            EXPECT_GT(std::nextafter(float(lo[axis]), INFINITY), part_lo[axis]);
            EXPECT_LT(std::nextafter(float(hi[axis]), -INFINITY), part_hi[axis]);
        }
    }
}

// Kernels may take subnormal floats for 0, on either side of a part.
TEST(Portal, HasABoxOfNormalFloats) {
    const double tiny = 1e-42, least = std::numeric_limits<float>::min();
    const Box around = portal_into(Frame(), {dvec3(-tiny, 0, tiny), dvec3(tiny, 0, 1)}).box;
    EXPECT_EQ(around.lo, dvec3(-least, 0, 0));
    EXPECT_EQ(around.hi, dvec3(least, 0, 1));
    EXPECT_EQ(portal_into(Frame(), {dvec3(-1), dvec3(-tiny)}).box.hi, dvec3(0));
}

} // namespace
} // namespace ovc
