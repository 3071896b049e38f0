// SPDX-License-Identifier: Apache-2.0
// Level 1: leaf sizes, and walks leaf by leaf that must find the hits of testing every triangle.
#include "kdtree/partition.h"

#include "kdtree/restart.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <set>

namespace ovc {
namespace {

Level1 cut(const Soup& soup, uint32_t max_triangles) {
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    return partition(soup, ids, bounds, max_triangles);
}

/// Traces leaf by leaf and tests all triangles of each; after the first hit only the leaves of its
/// cell are left.
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
        for (const uint32_t max_triangles : {1000u, 50u, 7u}) {
            const Level1 level1 = cut(soup, max_triangles);
            std::set<TriangleId> all;
            for (const Leaf& leaf : level1.leaves) {
                EXPECT_LE(leaf.triangles.size(), max_triangles) << name;
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
        for (const uint32_t max_triangles : {100000u, 300u, 40u}) {
            const Level1 level1 = cut(soup, max_triangles);
            for (size_t i = 0; i < rays.size(); ++i) {
                if (!rays[i].valid() || !can_walk(level1, PreparedRay(rays[i])))
                    continue;
                const Hit expected = test::brute_force(soup, ids, rays[i]);
                const Hit found = trace(level1, soup, rays[i]);
                ASSERT_TRUE(test::same(expected, found))
                    << name << " leaves of " << max_triangles << " ray " << i << ": "
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

Level1 cut_with_far_leaves(const Soup& soup, uint32_t max_triangles) {
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    return partition(soup, ids, bounds, max_triangles, nullptr, {}, {.allowed = true});
}

/// All planes through a heap of triangles that is smaller than the padding of cells would leave all
/// of it on both sides.
TEST(Partition, DoesNotCutWhatPaddingWouldJoinAgain) {
    test::Random random(/* seed= */ 6);
    std::vector<dvec3> corners;
    for (int i = 0; i < 3 * 300; ++i)
        corners.push_back((i < 3 ? 1e30 : 1e-10) * random.point(-1, 1));
    Soup soup;
    soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
    EXPECT_LE(cut(soup, 30).reference_count(), 2 * soup.triangle_count());
}

TEST(FarLeaf, HoldsTheFloorAndNoOtherLeafDoes) {
    const Soup soup = test::grid_on_floor(24);
    const uint32_t floor = 1; // the mesh
    const Level1 level1 = cut_with_far_leaves(soup, 60);
    ASSERT_EQ(level1.far_leaves, 1u);
    EXPECT_EQ(level1.leaves[0].triangles, (std::vector<TriangleId>{{floor, 0}, {floor, 1}}));
    for (size_t i = 1; i < level1.leaves.size(); ++i)
        for (const TriangleId id : level1.leaves[i].triangles)
            EXPECT_NE(id.mesh, floor) << "leaf " << i;
    for (const KdNode& node : level1.nodes)
        EXPECT_TRUE(!node.is_leaf() || node.count() == 0 || node.first() > 0);
    EXPECT_EQ(leaf_at(level1, {3, 2, -0.3}, {floor, 0}), 0u);

    const Level1 without = cut(soup, 60);
    EXPECT_EQ(without.far_leaves, 0u);
    EXPECT_GE(without.reference_count(), level1.reference_count() + 2 * (kFarCells - 1));
}

TEST(FarLeaf, IsNoneWhereManyTrianglesReachFar) {
    EXPECT_EQ(cut_with_far_leaves(test::random_soup(3, 1000, 0.6), 40).far_leaves, 0u);
    EXPECT_EQ(cut_with_far_leaves(test::closed_grid(24), 60).far_leaves, 0u);
    EXPECT_EQ(cut_with_far_leaves(test::grid_on_floor(24), 1).far_leaves, 0u) << "of one at most";
    EXPECT_EQ(cut_with_far_leaves(test::grid_on_floor(4), 10).far_leaves, 0u) << "a sixteenth";
}

TEST(FarLeaf, IsCutAgainLikeTheOthers) {
    const Soup soup = test::grid_on_floor(24);
    const Level1 before = cut_with_far_leaves(soup, 60);
    std::vector<uint32_t> max_triangles(before.leaves.size(), kNone), was;
    const Level1 same = cut_again(soup, before, max_triangles, was);
    EXPECT_EQ(same.far_leaves, 1u);
    EXPECT_EQ(same.leaves.size(), before.leaves.size());
    EXPECT_EQ(was[0], 0u);

    max_triangles[0] = 1;
    max_triangles.back() = 7;
    const Level1 smaller = cut_again(soup, before, max_triangles, was);
    ASSERT_EQ(smaller.far_leaves, 2u);
    for (uint32_t i = 0; i < 2; ++i) {
        EXPECT_EQ(smaller.leaves[i].triangles.size(), 1u);
        EXPECT_EQ(was[i], kNone);
    }
    EXPECT_EQ(was[2], 1u);
    EXPECT_EQ(was.back(), kNone);
    EXPECT_EQ(was.size(), smaller.leaves.size());
}

} // namespace
} // namespace ovc
