// SPDX-License-Identifier: Apache-2.0
#include "plugin/hosts/tachyon/beside.h"

#include <gtest/gtest.h>

namespace ovc::tachyon {
namespace {

/// The corners (0, 0), (4, 0), (0, 2) at z = 5.
Triangle triangle() {
    Triangle t{};
    t.v0 = {0, 0, 5};
    t.edge1 = {4, 0, 0};
    t.edge2 = {0, 2, 0};
    return t;
}

ovc_ray down_to(double x, double y) {
    return {{x, y, 0}, 0.5, {0, 0, 1}, 100};
}

ovc_hit hit(double u, double v) {
    return {5, u, v, 0, 0};
}

bool inside(const ovc_ray& ray) {
    return ray.org[0] >= 0 && ray.org[1] >= 0 && ray.org[0] / 4 + ray.org[1] / 2 <= 1;
}

TEST(RaysBeside, HitInsideHasNone) {
    EXPECT_EQ(rays_beside(down_to(1, 0.5), hit(0.25, 0.25), triangle()).count, 0u);
}

TEST(RaysBeside, HitOnEachSideHasOneAcrossIt) {
    struct Case {
        double u, v;
    };
    for (const Case& c : {Case{0.3, 0}, Case{0, 0.7}, Case{0.6, 0.4}, Case{1e-9, 0.5}}) {
        const RaysBeside beside = rays_beside(down_to(4 * c.u, 2 * c.v), hit(c.u, c.v), triangle());
        ASSERT_EQ(beside.count, 1u) << c.u << " " << c.v;
        EXPECT_FALSE(inside(beside.rays[0])) << c.u << " " << c.v;
        EXPECT_NEAR(beside.rays[0].org[0], 4 * c.u, 1e-6);
        EXPECT_NEAR(beside.rays[0].org[1], 2 * c.v, 1e-6);
        EXPECT_LT(beside.rays[0].t_min, 5);
        EXPECT_GT(beside.rays[0].t_min, 4.99);
        EXPECT_EQ(beside.rays[0].t_max, 100);
    }
}

TEST(RaysBeside, HitOnACornerHasThreeAroundIt) {
    const RaysBeside beside = rays_beside(down_to(4, 0), hit(1, 0), triangle());
    ASSERT_EQ(beside.count, 3u);
    for (const ovc_ray& ray : beside)
        EXPECT_TRUE(!inside(ray) || ray.org[1] == 0) << ray.org[0] << " " << ray.org[1];
    EXPECT_FALSE(inside(beside.rays[2]));
}

} // namespace
} // namespace ovc::tachyon
