// SPDX-License-Identifier: Apache-2.0
// The builder's promises: completeness, the stop by count, and a bounded size on inputs that cannot
// be cut.
#include "kdtree/build.h"

#include "kdtree/clip.h"
#include "kdtree/partition.h"
#include "kdtree/test_soups.h"
#include "kdtree/traverse.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace ovc {
namespace {

void check_cells(const Soup& soup, const KdTree& tree, const std::vector<TriangleId>& ids,
                 uint32_t node, const Box& cell, const std::string& name) {
    const KdNode& n = tree.nodes[node];
    if (!n.is_leaf()) {
        Box below = cell, above = cell;
        below.hi[n.axis()] = above.lo[n.axis()] = n.split();
        ASSERT_GT(n.split(), cell.lo[n.axis()]) << name;
        ASSERT_LT(n.split(), cell.hi[n.axis()]) << name;
        check_cells(soup, tree, ids, node + 1, below, name);
        check_cells(soup, tree, ids, n.above(), above, name);
        return;
    }
    const auto in_leaf = tree.triangles(n);
    const std::set<TriangleId> listed(in_leaf.begin(), in_leaf.end());
    ASSERT_EQ(listed.size(), in_leaf.size()) << name << ": a triangle twice in a leaf";
    const Box inner = cell.padded(-1e-9 * max_component(tree.bounds.extent()));
    for (const TriangleId id : ids)
        if (!inner.empty() && !clipped_bounds(soup.triangle(id), inner).empty()) {
            ASSERT_TRUE(listed.count(id)) << name << " prim " << id.prim;
        }
}

TEST(KdTreeBuild, EveryTriangleIsInEveryLeafItTouches) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        if (soup.triangle_count() > 1000)
            continue; // leaves x triangles tests
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        const KdTree tree = build_kd_tree(soup);
        if (!tree.nodes.empty())
            check_cells(soup, tree, ids, 0, tree.bounds, name);
        EXPECT_EQ(tree.nodes.empty(), ids.empty()) << name;
    }
}

TEST(KdTreeBuild, StoppedByCountLeavesNoMoreThanThat) {
    const Soup soup = test::random_soup(4, 5000, 0.01);
    for (const uint32_t max_triangles : {2000u, 500u, 100u}) {
        KdBuildOptions options;
        options.max_leaf_triangles = max_triangles;
        const KdTree tree = build_kd_tree(soup, options);
        for (const KdNode& node : tree.nodes)
            if (node.is_leaf()) {
                EXPECT_LE(node.count(), max_triangles);
            }
        EXPECT_LT(tree.references.size(), 2 * soup.triangle_count());
    }
}

TEST(KdTreeBuild, ReferencesStayBoundedWhereNothingCanBeCut) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        KdBuildOptions options;
        options.max_leaf_triangles = 1;
        EXPECT_LE(build_kd_tree(soup, options).references.size(), 100 * soup.triangle_count())
            << name;
    }
}

/// Copies far apart, in so large a scene that all triangles of one are alike to its padding.
TEST(KdTreeBuild, ReferencesOfLevel1StayBoundedWherePaddingHidesTheTriangles) {
    for (uint64_t seed = 1; seed <= 40; ++seed) {
        test::Random random(seed);
        std::vector<dvec3> near, corners;
        for (int i = 0; i < 100; ++i) {
            const dvec3 middle = glm::floor(random.point(-4, 5));
            for (int k = 0; k < 3; ++k)
                near.push_back(middle + 0.5 * glm::floor(random.point(-4, 5)));
        }
        corners = near;
        for (int place = 0; place < 8; ++place) {
            const int axis = int(random.below(3));
            const double far = std::pow(10.0, double(random.below(31)));
            for (dvec3 corner : near) {
                corner[axis] += far;
                corners.push_back(corner);
            }
        }
        Soup soup;
        soup.chunks.push_back(Chunk::owning_doubles(dvec3(0), std::move(corners)));
        KdBuildOptions options;
        options.max_leaf_triangles = 16;
        Box bounds;
        const auto triangles = hittable_triangles(soup, nullptr, &bounds);
        options.padding = 2 * padding_of(bounds);
        EXPECT_LE(build_kd_tree(soup, options).references.size(), 48 * soup.triangle_count());
    }
}

/// The triangles are large, in one flat box: every cut across it pays, and cuts nearly all of them.
TEST(KdTreeBuild, ReferencesStayBoundedWhereAllOverlapInAPlane) {
    test::Random random(5);
    std::vector<vec3> corners;
    for (int i = 0; i < 3 * 4000; ++i) {
        const double a = 2.0944 * (i % 3);
        corners.push_back(
            vec3(9 * std::cos(a) + random(-1, 1), 9 * std::sin(a) + random(-1, 1), 0.3));
    }
    const Soup soup = test::one_chunk(std::move(corners));
    const KdTree tree = build_kd_tree(soup);
    EXPECT_LE(tree.references.size(), 24u * 4000);
    EXPECT_TRUE(intersect(tree, soup, Ray{dvec3(0.1, 0.2, 5), 0, dvec3(0, 0, -1)}).is_hit());
}

/// As letters before a large floor: a cut in the middle of the scene runs along all triangles.
TEST(KdTreeBuild, CutsTrianglesInThePlaneInTheMiddle) {
    test::Random random(7);
    std::vector<vec3> corners;
    for (int i = 0; i < 8000; ++i) {
        const vec3 at(random(0, 9), random(0, 9), 0);
        corners.insert(corners.end(), {at, at + vec3(0.1f, 0, 0), at + vec3(0, 0.1f, 0)});
    }
    for (const float end : {-1000.0f, 1000.0f})
        corners.insert(corners.end(), {vec3(end), {end, -end, end}, {-end, end, end}});
    const KdTree tree = build_kd_tree(test::one_chunk(std::move(corners)));
    for (const KdNode& node : tree.nodes)
        if (node.is_leaf()) {
            EXPECT_LE(node.count(), 100u);
        }
}

TEST(KdTreeBuild, IsTheSameOnEveryRun) {
    const Soup soup = test::random_soup(6, 20000, 0.02);
    const KdTree a = build_kd_tree(soup);
    const KdTree b = build_kd_tree(soup);
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    EXPECT_EQ(a.references, b.references);
}

} // namespace
} // namespace ovc
