// SPDX-License-Identifier: Apache-2.0
// The boxes of a portal's node hold what lies behind the portal, and little else.
#include "gpu/page/portal_boxes.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace ovc {
namespace {

struct WholePage {
    Leaf leaf;
    std::vector<Page> pages;
};

WholePage whole_page_of(const Soup& soup) {
    Box bounds;
    const std::vector<TriangleId> triangles = hittable_triangles(soup, nullptr, &bounds);
    Level1 level1 = partition(soup, triangles, bounds, uint32_t(triangles.size()));
    const Leaf& leaf = level1.leaves.front();
    return {leaf, {build_page(soup, Numbering(soup), leaf)}};
}

Transform any_way(test::Random& random) {
    Transform transform{};
    for (auto& row : transform.rows) {
        const dvec3 v = random.point(-1, 1);
        row = {v.x, v.y, v.z, 1000 * random.point(-1, 1).x};
    }
    return transform;
}

TEST(PortalBoxes, HoldAllPointsOfPlacedTriangles) {
    test::Random random(5);
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        Box bounds;
        const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
        if (ids.empty())
            continue;
        const auto [leaf, pages] = whole_page_of(soup);
        const PartOutline outline(pages);
        const Transform transform = any_way(random);
        for (const Transform* way : {static_cast<const Transform*>(nullptr), &transform}) {
            const PartOutline::Groups groups = outline.placed(leaf.frame, way);
            for (int i = 0; i < 300; ++i) {
                const Triangle t = soup.triangle(ids[random.below(uint32_t(ids.size()))]);
                dvec3 weights = random.point(0, 1);
                weights /= weights.x + weights.y + weights.z;
                const dvec3 p =
                    or_identity(way)(weights.x * t[0] + weights.y * t[1] + weights.z * t[2]);
                EXPECT_TRUE(std::ranges::any_of(groups, [&](const Box& box) {
                    return box.contains(p);
                })) << name;
            }
        }
    }
}

// The box of the box of a long mesh that was turned by 45 degrees is wide; one around its nodes is
// not.
TEST(PortalBoxes, AreTightAroundWhatWasTurned) {
    test::Random random(6);
    std::vector<vec3> corners;
    for (int i = 0; i < 1000; ++i) {
        const dvec3 middle = dvec3(10, 0.1, 0.1) * random.point(-1, 1);
        for (int corner = 0; corner < 3; ++corner)
            corners.push_back(vec3(middle + 0.05 * random.point(-1, 1)));
    }
    const Soup soup = test::one_chunk(std::move(corners));
    const auto [leaf, pages] = whole_page_of(soup);
    const double half = std::numbers::sqrt2 / 2;
    const Transform turned{{{{half, -half, 0, 0}, {half, half, 0, 0}, {0, 0, 1, 0}}}};
    double area = 0;
    for (const Box& box : PartOutline(pages).placed(leaf.frame, &turned))
        area += box.half_area();
    EXPECT_LT(area, 0.4 * placed_box(leaf.grid, &turned).half_area());
}

} // namespace
} // namespace ovc
