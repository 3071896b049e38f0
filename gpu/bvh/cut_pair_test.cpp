// SPDX-License-Identifier: Apache-2.0
// The two parts hold all of a pair that a plane cuts, also if corners were rounded or lie on the
// plane.
#include "gpu/bvh/cut_pair.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// A corner in double, and the float that it is rounded to.
struct Corner {
    dvec3 exact;
    vec3 rounded;
};

Corner corner(test::Random& random, double reach) {
    Corner c;
    c.exact = random.point(-reach, reach);
    c.rounded = vec3(c.exact);
    return c;
}

bool holds(const Boxf& box, const dvec3& p) {
    return !box.empty() && Box{dvec3(box.lo), dvec3(box.hi)}.contains(p);
}

/// Checks a cut, and cuts of its parts, which are smaller boxes of the same pair.
void expect_held(const TrianglePair& pair, const std::array<Corner, 4>& corners, const Boxf& box,
                 test::Random& random, int cuts) {
    const int axis = int(random.point(0, 3).x) % 3;
    const float share = float(random.point(0, 1).x);
    // Planes through a corner's coordinate are the hard ones.
    const float plane =
        random.point(0, 1).y < 0.3
            ? std::clamp(pair.corners[size_t(axis)][axis], box.lo[axis], box.hi[axis])
            : box.lo[axis] + share * (box.hi[axis] - box.lo[axis]);
    const CutPair cut = cut_pair(pair, box, axis, plane);
    for (int i = 0; i < 200; ++i) {
        const bool second = i & 1;
        dvec3 w = random.point(0, 1);
        if (i % 5 == 0)
            w.x = 0; // on a side
        w /= w.x + w.y + w.z;
        dvec3 p =
            w.x * corners[0].exact + w.y * corners[second ? 3 : 1].exact + w.z * corners[2].exact;
        if (i % 3 == 0) { // moved along a side onto the plane, up to rounding
            const dvec3& a = corners[0].exact;
            const dvec3& b = corners[2].exact;
            const double t = (plane - a[axis]) / (b[axis] - a[axis]);
            if (!(t >= 0 && t <= 1))
                continue;
            p = a + t * (b - a);
        }
        if (holds(box, p)) {
            ASSERT_TRUE(holds(cut.below, p) || holds(cut.above, p)) << i << " at " << plane;
        }
    }
    if (cuts == 0)
        return;
    for (const Boxf& part : {cut.below, cut.above})
        if (!part.empty())
            expect_held(pair, corners, part, random, cuts - 1);
}

TEST(CutPair, LosesNoPoint) {
    for (uint64_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        test::Random random(seed);
        const double reach = std::array{1.0, 1e3, 1e-3}[seed % 3];
        std::array<Corner, 4> corners;
        for (Corner& c : corners)
            c = corner(random, reach);
        TrianglePair pair{};
        Boxf box;
        for (size_t i = 0; i < 4; ++i) {
            pair.corners[i] = corners[i].rounded;
            box.add(corners[i].rounded);
        }
        pair.a = 0;
        pair.b = 1;
        const Boxf inside{vec3(-1), vec3(1)};
        box = {glm::clamp(box.lo, inside.lo, inside.hi), glm::clamp(box.hi, inside.lo, inside.hi)};
        expect_held(pair, corners, box, random, 3);
    }
}

TEST(CutPair, IsTightToAFewRoundings) {
    const TrianglePair pair{{vec3(0), vec3(1, 0, 0), vec3(1, 1, 0), vec3(0, 1, 0)}, 0, 1, 0};
    const CutPair cut = cut_pair(pair, {vec3(0), vec3(1, 1, 0)}, 0, 0.25f);
    EXPECT_NEAR(cut.below.hi.x, 0.25, 1e-6);
    EXPECT_NEAR(cut.above.lo.x, 0.25, 1e-6);
    EXPECT_EQ(cut.below.lo.x, 0);
    EXPECT_EQ(cut.above.hi.x, 1);
    EXPECT_EQ(cut.below.hi.z, 0);
    EXPECT_TRUE(cut_pair(pair, {vec3(0), vec3(1, 1, 0)}, 0, -1).below.empty());
}

} // namespace
} // namespace ovc
