// SPDX-License-Identifier: Apache-2.0
// Duplicates and ties: of triangles that a ray hits at the same t the one with the smaller id
// answers, wherever they lie.
#include "plugin/two_level/test_two_level.h"

#include "kdtree/build.h"
#include "kdtree/traverse.h"

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

using test::ok;

/// The triangles of `once` in three meshes: the second has some of them twice, the third all of
/// them; each copy's corners are turned and wound in a way of its own.
Soup tripled(const Soup& once) {
    constexpr int kOrders[6][3] = {{0, 1, 2}, {1, 2, 0}, {2, 0, 1},
                                   {0, 2, 1}, {2, 1, 0}, {1, 0, 2}};
    const auto corners = once.chunks[0].corners();
    std::vector<vec3> meshes[3];
    for (uint32_t prim = 0; prim < once.triangle_count(); ++prim)
        for (uint32_t copy = 0; copy < 4; ++copy) {
            if (copy == 0 && prim % 3 == 0)
                continue;
            if (copy == 2 && prim % 2)
                continue;
            const int* order = kOrders[(prim + 2 * copy) % 6];
            for (int i = 0; i < 3; ++i)
                meshes[std::max(copy, 1u) - 1].push_back(corners[prim * 3 + uint32_t(order[i])]);
        }
    Soup soup;
    for (auto& mesh : meshes)
        soup.chunks.push_back(Chunk::owning(once.chunks[0].origin(), std::move(mesh)));
    return soup;
}

/// Rays that start on triangles of the soup, which they do not see, and rays that do not see a
/// triangle elsewhere on their way.
void rays_that_skip(const Soup& soup, size_t count, std::vector<Ray>& rays,
                    std::vector<TriangleId>& skip) {
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    test::Random random(19);
    for (size_t i = 0; i < count; ++i) {
        const TriangleId id = ids[random.below(ids.size())];
        const Triangle t = soup.triangle(id);
        const double u = i % 5 ? random(0, 0.5) : 0, v = i % 7 ? random(0, 0.5) : 0;
        const dvec3 at = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
        const dvec3 dir = random.point(-1, 1);
        rays.push_back({i % 2 ? at : at - dir, 0, dir});
        skip.push_back(id);
    }
}

TEST_F(TwoLevelGl, DuplicatesAnswerAsBruteForceDoes) {
    const Soup single[] = {test::random_soup(2, 700, 0.05), test::closed_grid(12),
                           test::closed_grid(12, dvec3(4.5e6, 6e6, -6))};
    for (const Soup& once : single) {
        const Soup soup = tripled(once);
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        std::vector<Ray> rays = test::unpleasant_rays(soup, 35, 800);
        std::vector<TriangleId> skip(rays.size());
        rays_that_skip(soup, 1600, rays, skip);
        std::vector<Hit> expected;
        size_t met_a_duplicate = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            expected.push_back(test::brute_force(soup, ids, rays[i], skip[i]));
            met_a_duplicate += expected[i].is_hit() && skip[i].mesh != kNone &&
                               same_corners(soup.triangle(expected[i].id), soup.triangle(skip[i]));
        }
        EXPECT_GT(met_a_duplicate, 400u);
        for (const auto& [name, options] : variants()) {
            SCOPED_TRACE(name);
            const auto structure = build(soup, options);
            ASSERT_TRUE(structure);
            EXPECT_EQ(structure->scene().duplicates.count(), ids.size() - once.triangle_count());
            // They are not equal, because pairs depend on how triangles are numbered.
            const auto alone = double(build(once, options)->scene().level2_bytes());
            EXPECT_NEAR(double(structure->scene().level2_bytes()), alone, 0.05 * alone);
            std::vector<Hit> hits(rays.size());
            std::vector<uint8_t> shadows(rays.size());
            ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
            ASSERT_TRUE(ok(structure->occluded(rays, skip, shadows)));
            for (size_t i = 0; i < rays.size(); ++i) {
                ASSERT_TRUE(test::same(expected[i], hits[i]))
                    << "ray " << i << ": " << test::describe(expected[i]) << " but found "
                    << test::describe(hits[i]);
                ASSERT_EQ(expected[i].is_hit(), shadows[i] != 0) << "ray " << i;
            }
        }
    }
}

TEST_F(TwoLevelGl, DuplicatesAreNotFlaggedForEachOther) {
    const Soup soup = tripled(test::closed_grid(100));
    const auto structure = build(soup, {});
    ASSERT_TRUE(structure);
    const auto rays = test::rays_from_outside(5, 20000);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    EXPECT_LE(structure->statistics().flagged, rays.size() / 100);
}

TEST_F(TwoLevelGl, FastPrecisionSeesTheDuplicateOfWhatItSkips) {
    const Soup soup = tripled(test::closed_grid(12));
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;
    rays_that_skip(soup, 4000, rays, skip);
    const auto structure = build(soup, {.certify = false});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, skip, hits)));
    size_t same = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const Hit expected = test::brute_force(soup, ids, rays[i], skip[i]);
        if (!expected.is_hit() || hits[i].id != expected.id || expected.t < 0.01)
            continue;
        ++same;
        EXPECT_NEAR(hits[i].t, expected.t, 1e-4);
        EXPECT_NEAR(hits[i].u, expected.u, 1e-2);
        EXPECT_NEAR(hits[i].v, expected.v, 1e-2);
    }
    EXPECT_GT(same, rays.size() / 3);
}

/// Rectangles that overlap in the plane z = 0, in front of a wall: level 1 cuts many thin cells
/// along that plane.
Soup overlapping_rectangles(int count) {
    test::Random random(41);
    const auto on_grid = [&](double lo, double hi) {
        return float(std::round(random(lo, hi) * 4096) / 4096);
    };
    std::vector<vec3> corners;
    const auto add_rectangle = [&](vec3 a, vec3 x, vec3 y) {
        corners.insert(corners.end(), {a, a + x, a + x + y, a, a + x + y, a + y});
    };
    for (int i = 0; i < 16; ++i)
        add_rectangle(vec3(float(i % 4) / 2 - 1, float(i / 4) / 2 - 1, -1), vec3(0.5f, 0, 0),
                      vec3(0, 0.5f, 0));
    for (int i = 0; i < count; ++i)
        add_rectangle(vec3(on_grid(-1, 0.5), on_grid(-1, 0.5), 0), vec3(on_grid(0.01, 0.5), 0, 0),
                      vec3(0, on_grid(0.01, 0.5), 0));
    return test::one_chunk(std::move(corners));
}

// Triangles in one plane are in many leaves, of one cell and of the next, and t is rounded
// differently for each triangle.
TEST_F(TwoLevelGl, TiesAcrossLeavesAndCellsGoToTheSmallerId) {
    const Soup soup = overlapping_rectangles(400);
    const KdTree tree = build_kd_tree(soup);
    test::Random random(42);
    std::vector<Ray> rays(10000);
    for (Ray& ray : rays) {
        const Triangle t = soup.triangle({0, uint32_t(random.below(soup.triangle_count()))});
        const dvec3 target = t[0] + random(0, 1) * (t[1] - t[0]);
        ray.org = dvec3(vec3(target + std::exp(random(-4, 1)) * random.point(-1, 1)));
        ray.dir = dvec3(vec3(target - ray.org));
    }
    std::vector<Hit> expected(rays.size()), hits(rays.size());
    intersect(tree, soup, rays, {}, expected);
    const auto structure = build(soup, {.leaf_triangles = 40});
    ASSERT_TRUE(structure);
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i)
        ASSERT_TRUE(test::same(expected[i], hits[i]))
            << "ray " << i << ": " << test::describe(expected[i]) << " but found "
            << test::describe(hits[i]);
}

} // namespace
} // namespace ovc
