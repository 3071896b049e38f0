// SPDX-License-Identifier: Apache-2.0
// Level 1 of every kind: leaves keep to the count, every triangle is in the leaves wherever it
// lies, and a walk leaf by leaf finds the hits that testing every triangle finds.
#include "plugin/thesis/level1/level1_walk.h"

#include "kdtree/build.h"
#include "kdtree/test_soups.h"
#include "plugin/thesis/level1/merge_leaves.h"
#include "plugin/thesis/queued/test_kinds.h"

#include <gtest/gtest.h>

#include <set>

namespace ovc::thesis {
namespace {

/// Level 1 of a soup, and its triangles.
struct Built {
    Box bounds;
    std::vector<TriangleId> ids;
    Level1Walk walk;
    Level1 level1;

    Built(const Soup& soup, const Kind& kind, uint32_t max_triangles)
        : ids(hittable_triangles(soup, nullptr, &bounds)) {
        level1 = Level1Builder(soup, ids, bounds, kind.level1, kind.build).cut(max_triangles, walk);
    }
    bool can_walk(const Ray& ray) const { return ovc::can_walk(level1, PreparedRay(ray)); }
};

/// Returns all leaves on the ray's way, in order.
std::vector<uint32_t> leaves_along(const Built& built, const Ray& ray) {
    const PreparedRay p(ray);
    RayPlace place{{ray.t_min}};
    std::vector<uint32_t> leaves;
    for (Visit visit; (visit = next_leaf(built.walk, built.level1, p, place)).leaf != kNone;)
        leaves.push_back(visit.leaf);
    return leaves;
}

/// Traces as the queues do: after a hit no leaf beyond it, after one in a cell only that cell's.
Hit trace(const Built& built, const Soup& soup, const Ray& ray) {
    PreparedRay rest(ray);
    Nearest nearest(rest);
    const PreparedRay p(ray);
    RayPlace place{{ray.t_min}};
    bool in_cell = false;
    while (true) {
        const Visit visit = in_cell ? next_leaf_in_cell(built.level1, rest, place)
                                    : next_leaf(built.walk, built.level1, rest, place);
        if (visit.leaf == kNone)
            return nearest.hit();
        const Leaf& leaf = built.level1.leaves[visit.leaf];
        for (const TriangleId id : leaf.triangles)
            nearest.offer(soup.triangle(id), id);
        if (!nearest.hit().is_hit())
            continue;
        const Box safe = leaf.cell.padded(-p.margin(leaf.cell));
        in_cell = built.walk.along_the_ray() &&
                  nearest.limit() <= clip(p, safe, ray.t_min, ray.t_max).exit;
        rest.ray.t_max = std::min(rest.ray.t_max, nearest.limit());
    }
}

TEST(Level1, LeavesKeepToTheCountAndHoldEveryTriangle) {
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const Kind& kind : kinds())
            for (const uint32_t max_triangles : {1000u, 50u, 7u}) {
                SCOPED_TRACE(name + ", " + kind.name + ", " + std::to_string(max_triangles));
                const Built built(soup, kind, max_triangles);
                std::set<TriangleId> all;
                for (const Leaf& leaf : built.level1.leaves) {
                    EXPECT_LE(leaf.triangles.size(), max_triangles);
                    EXPECT_FALSE(leaf.triangles.empty());
                    EXPECT_TRUE(std::is_sorted(leaf.triangles.begin(), leaf.triangles.end()));
                    all.insert(leaf.triangles.begin(), leaf.triangles.end());
                }
                EXPECT_EQ(all, std::set(built.ids.begin(), built.ids.end()));
                if (kind.level1 == OVC_LEVEL1_BVH) {
                    EXPECT_EQ(built.level1.reference_count(), built.ids.size());
                }
            }
}

TEST(Level1, EachPointOfATriangleFindsItInALeafWhoseCellHoldsThePoint) {
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const Kind& kind : kinds()) {
            const Built built(soup, kind, 40);
            test::Random random(7);
            for (const TriangleId id : built.ids) {
                const Triangle t = soup.triangle(id);
                const double u = random(0, 1), v = random(0, 1 - u);
                const dvec3 point = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
                bool found = false;
                for (const Leaf& leaf : built.level1.leaves)
                    found = found ||
                            (leaf.box.contains(point) && leaf.cell.contains(point) &&
                             std::binary_search(leaf.triangles.begin(), leaf.triangles.end(), id));
                EXPECT_TRUE(found) << name << ", " << kind.name;
            }
        }
}

TEST(Level1, WalkingLeavesFindsWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        const auto rays = test::unpleasant_rays(soup, 21, 400);
        std::vector<Hit> expected;
        for (const Ray& ray : rays)
            expected.push_back(test::brute_force(soup, ids, ray));
        for (const Kind& kind : kinds())
            for (const uint32_t max_triangles : {100000u, 300u, 40u}) {
                const Built built(soup, kind, max_triangles);
                for (size_t i = 0; i < rays.size(); ++i)
                    if (rays[i].valid() && built.can_walk(rays[i])) {
                        const Hit found = trace(built, soup, rays[i]);
                        ASSERT_TRUE(test::same(expected[i], found))
                            << name << ", " << kind.name << ", leaves of " << max_triangles
                            << ", ray " << i << ": " << test::describe(expected[i]) << " but found "
                            << test::describe(found);
                    }
            }
    }
}

/// Both have leaves of the same cells, so both walks come to the same leaves in the same order.
TEST(Level1, TheGridsWalkIsThatOfRestartsInTheSameCells) {
    const Soup soup = test::random_soup(4, 5000, 0.02);
    const Built grid(soup, {"", OVC_LEVEL1_GRID, OVC_LEVEL1_BUILD_TOP_DOWN}, 30);
    Built restarts = grid;
    restarts.walk.kind = OVC_LEVEL1_KD_TREE;
    test::Random random(9);
    size_t longest = 0;
    for (int i = 0; i < 5000; ++i) {
        const Ray ray{random.point(-1, 2), 0, random.point(-1, 1)};
        const std::vector<uint32_t> leaves = leaves_along(grid, ray);
        ASSERT_EQ(leaves, leaves_along(restarts, ray)) << "ray " << i;
        longest = std::max(longest, leaves.size());
    }
    EXPECT_GT(longest, 5u);
}

/// The walk leaves out no leaf whose inside the ray passes through, whatever the kind.
TEST(Level1, NoRayMissesALeaf) {
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const Kind& kind : kinds()) {
            const Built built(soup, kind, 60);
            const auto rays = test::unpleasant_rays(soup, 13, 300);
            for (size_t i = 0; i < rays.size(); ++i) {
                if (!rays[i].valid() || !built.can_walk(rays[i]))
                    continue;
                const std::vector<uint32_t> leaves = leaves_along(built, rays[i]);
                const std::set<uint32_t> met(leaves.begin(), leaves.end());
                EXPECT_EQ(met.size(), leaves.size()) << "a leaf twice";
                const PreparedRay p(rays[i]);
                for (uint32_t l = 0; l < built.level1.leaves.size(); ++l) {
                    // The unpadded cell, made smaller by the roundings of doubles.
                    const Leaf& leaf = built.level1.leaves[l];
                    const Box inner = leaf.cell.padded(-2 * built.level1.padding);
                    const Interval inside =
                        clip(p, inner.intersection(leaf.box), p.ray.t_min, p.ray.t_max);
                    const bool passes_through = !inner.empty() && inside.enter < inside.exit;
                    EXPECT_TRUE(met.contains(l) || !passes_through)
                        << name << ", " << kind.name << ", ray " << i << ", leaf " << l;
                }
            }
        }
}

TEST(MergeLeaves, MergesAllThatMayBeMergedAndNoMore) {
    const Soup soup = test::closed_grid(40);
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    const KdTree full = build_kd_tree(soup, ids, bounds, {});
    const auto leaves = [](const std::vector<KdNode>& nodes) {
        return std::count_if(nodes.begin(), nodes.end(), [](auto& n) { return n.is_leaf(); });
    };
    EXPECT_EQ(leaves(merge_leaves(full, uint32_t(ids.size()))), 1);
    ptrdiff_t before = 1;
    for (const uint32_t max_triangles : {1000u, 200u, 40u}) {
        const Level1 level1 =
            fill_cells(soup, ids, bounds, merge_leaves(full, max_triangles), max_triangles);
        EXPECT_GT(leaves(level1.nodes), before);
        before = leaves(level1.nodes);
        // Two leaf nodes side by side would not have fitted into one.
        for (size_t n = 0; n + 2 < level1.nodes.size(); ++n) {
            const KdNode& node = level1.nodes[n];
            if (node.is_leaf() || !level1.nodes[n + 1].is_leaf() ||
                !level1.nodes[node.above()].is_leaf())
                continue;
            std::set<TriangleId> both;
            for (const KdNode& child : {level1.nodes[n + 1], level1.nodes[node.above()]})
                for (uint32_t l = child.first(); l < child.first() + child.count(); ++l)
                    both.insert(level1.leaves[l].triangles.begin(),
                                level1.leaves[l].triangles.end());
            EXPECT_GT(both.size(), max_triangles);
        }
    }
    EXPECT_TRUE(merge_leaves(KdTree{}, 10).empty());
}

} // namespace
} // namespace ovc::thesis
