// SPDX-License-Identifier: Apache-2.0
// Level 1: leaf sizes, and that walking leaf by leaf finds what testing every triangle finds.
#include "kdtree/partition.h"

#include "kdtree/restart.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <set>

namespace ovc {
namespace {

Level1 cut(const Soup& soup, uint32_t most) {
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    return partition(soup, ids, bounds, most);
}

/// Leaf by leaf, all triangles of each tested; after the first hit only the leaves of its cell are
/// left.
Hit trace(const Level1& level1, const Soup& soup, const Ray& ray) {
    if (!ray.valid())
        return {};
    const PreparedRay p(ray);
    Nearest nearest(p);
    RayPosition position{ray.t_min};
    std::set<uint32_t> seen;
    while (true) {
        const Visit visit = nearest.hit().is_hit() ? next_leaf_in_cell(level1, p, position)
                                                   : next_leaf(level1, p, position);
        if (visit.leaf == kNone)
            return nearest.hit();
        EXPECT_TRUE(seen.insert(visit.leaf).second) << "a leaf twice";
        for (const TriangleId id : level1.leaves[visit.leaf].triangles)
            if (const auto hit = intersect(p, soup.triangle(id), id))
                if (hit->t <=
                    clip(p, level1.leaves[visit.leaf].cell, p.ray.t_min, p.ray.t_max).exit)
                    nearest.offer(soup.triangle(id), id);
    }
}

TEST(Partition, LeavesKeepToTheCountAndHoldEveryTriangle) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        for (const uint32_t most : {1000u, 50u, 7u}) {
            const Level1 level1 = cut(soup, most);
            std::set<TriangleId> all;
            for (const Leaf& leaf : level1.leaves) {
                EXPECT_LE(leaf.triangles.size(), most) << name;
                EXPECT_TRUE(std::is_sorted(leaf.triangles.begin(), leaf.triangles.end()));
                all.insert(leaf.triangles.begin(), leaf.triangles.end());
                const dvec3 corner = leaf.frame.to_local(leaf.box.hi);
                EXPECT_LE(max_component(glm::abs(corner)), 1) << name;
            }
            EXPECT_EQ(all.size(), hittable_triangles(soup, nullptr, nullptr).size()) << name;
        }
    }
}

TEST(Partition, WalkingLeavesFindsWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        const auto rays = test::unpleasant_rays(soup, 21, 600);
        for (const uint32_t most : {100000u, 300u, 40u}) {
            const Level1 level1 = cut(soup, most);
            for (size_t i = 0; i < rays.size(); ++i) {
                if (!rays[i].valid() || !can_walk(level1, PreparedRay(rays[i])))
                    continue;
                const Hit expected = test::brute_force(soup, ids, rays[i]);
                const Hit found = trace(level1, soup, rays[i]);
                ASSERT_TRUE(test::same(expected, found))
                    << name << " leaves of " << most << " ray " << i << ": "
                    << test::describe(expected) << " but found " << test::describe(found);
            }
        }
    }
}

TEST(Partition, RefusesToWalkWhereDoublesLoseTheLeaf) {
    const Soup soup = test::random_soup(2, 3000, 0.01);
    const Level1 level1 = cut(soup, 100);
    EXPECT_TRUE(can_walk(level1, PreparedRay(Ray{{1e3, 0, 0}, 0, {-1, 0, 0}})));
    EXPECT_FALSE(can_walk(level1, PreparedRay(Ray{{1e13, 0, 0}, 0, {-1, 0, 0}})));
    EXPECT_FALSE(can_walk(level1, PreparedRay(Ray{{0, 0, 0}, 0, {1, 1e-310, 0}})));
}

} // namespace
} // namespace ovc
