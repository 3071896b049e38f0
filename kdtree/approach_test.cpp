// SPDX-License-Identifier: Apache-2.0
// Rays from far away are answered exactly, and without testing every triangle.
#include "kdtree/approach.h"

#include "kdtree/build.h"
#include "kdtree/test_soups.h"
#include "kdtree/traverse.h"
#include "kdtree/walk.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

struct FarRays {
    const char* name;
    double distance; // of origins, in sizes of the scene
    double length;   // of directions
};

const FarRays kFarRays[] = {{"near", 3, 1},
                            {"thousands of sizes", 1e4, 1e-3},
                            {"beyond doubles' bits", 1e15, 1},
                            {"light years", 1e40, 1e-40},
                            {"as far as corners may be", 1e76, 1e76},
                            {"beyond that", 1e100, 1},
                            {"as far as doubles go", 1e300, 1e-7}};

class Approaching : public testing::Test {
protected:
    Approaching() : soup(test::closed_grid(24, dvec3(7, -3, 2))) {
        ids = hittable_triangles(soup, nullptr, &bounds);
        tree = build_kd_tree(soup, ids, bounds, {});
    }

    /// Returns a ray aimed at a vertex, as well as doubles can.
    Ray ray_of(const FarRays& far, test::Random& random) const {
        const dvec3 target = soup.triangle(ids[random.below(ids.size())])[random.below(3)];
        dvec3 away = random.point(-1, 1);
        if (random.below(3) == 0)
            away[int(random.below(3))] = 0; // from there a coordinate is exactly the vertex's
        if (random.below(4) == 0)
            away = dvec3(0, 0, 1);
        return {target + far.distance * away, -1e308, -far.length * away};
    }

    size_t leaves_on_the_way(const Ray& ray) const {
        const PreparedRay p(ray);
        const Approach approach(p, bounds);
        size_t leaves = 0;
        walk(
            tree.nodes, bounds, approach.ray(),
            [&](const KdNode&, double, double) {
                ++leaves;
                return false;
            },
            [&] { return approach.ray().ray.t_max; });
        return leaves;
    }

    Soup soup;
    Box bounds;
    std::vector<TriangleId> ids;
    KdTree tree;
};

TEST_F(Approaching, AnswersAreThoseOfTestingEveryTriangle) {
    for (const FarRays& far : kFarRays) {
        size_t hits = 0;
        for (uint64_t seed = 0; seed < 60; ++seed) {
            test::Random random(seed);
            const Ray ray = ray_of(far, random);
            const PreparedRay p(ray);
            Nearest nearest(p);
            for (const TriangleId id : ids)
                nearest.offer(soup.triangle(id), id);
            const Hit expected = nearest.hit(), got = intersect(tree, soup, ray, {});
            ASSERT_EQ(got.id, expected.id) << far.name << " seed " << seed;
            ASSERT_EQ(got.t, expected.t) << far.name << " seed " << seed;
            ASSERT_EQ(got.u, expected.u) << far.name << " seed " << seed;
            hits += expected.is_hit();
        }
        EXPECT_GT(hits, 10u) << far.name;
    }
}

TEST_F(Approaching, FewLeavesAreOnTheWayHoweverFarARayComesFrom) {
    for (const FarRays& far : kFarRays)
        for (uint64_t seed = 0; seed < 60; ++seed) {
            test::Random random(seed);
            EXPECT_LE(leaves_on_the_way(ray_of(far, random)), 150u) << far.name << " " << seed;
        }
}

/// The way through the scene takes longer than the largest double tells.
TEST(ApproachingSlowly, FindsWhatLiesBeforeTheLargestDouble) {
    for (const double x : {-1.1e8, -1.5e8, -2.6e8, -4e8, 8e8, -1e11, 1e15, -1e30}) {
        const Soup soup = test::one_chunk({vec3(1, -1, -1), vec3(1, 3, -1), vec3(1, -1, 3),
                                           vec3(x, 5, 5), vec3(x, 9, 5), vec3(x, 5, 9)});
        Box bounds;
        const std::vector<TriangleId> ids = hittable_triangles(soup, nullptr, &bounds);
        const KdTree tree = build_kd_tree(soup, ids, bounds, {});
        for (const double from : {-1e8, -9e7, -0.5e8}) {
            const Hit hit = intersect(tree, soup, {dvec3(from, 0, 0), 0, dvec3(1e-300, 0, 0)}, {});
            EXPECT_EQ(hit.id, (TriangleId{0, 0})) << x << " from " << from;
        }
    }
}

TEST_F(Approaching, NothingLiesBeyondTheLargestDouble) {
    const Ray ray{dvec3(1e308, 0, 0), 0, dvec3(-1e-300, 0, 0)};
    EXPECT_EQ(leaves_on_the_way(ray), 0u);
    EXPECT_FALSE(intersect(tree, soup, ray, {}).is_hit());
}

} // namespace
} // namespace ovc
