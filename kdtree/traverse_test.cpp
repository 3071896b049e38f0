// SPDX-License-Identifier: Apache-2.0
// The CPU KDT gives, bit for bit, the answers of testing every triangle.
#include "kdtree/traverse.h"

#include "kdtree/build.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(KdTraverse, EqualsBruteForceBitForBit) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const KdTree tree = build_kd_tree(soup);
        const auto ids = hittable_triangles(soup, nullptr, nullptr);
        const auto rays = test::unpleasant_rays(soup, 7, 1200);
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, ids, rays[i]);
            const Hit found = intersect(tree, soup, rays[i]);
            ASSERT_TRUE(test::same(expected, found))
                << name << " ray " << i << ": " << test::describe(expected) << " but found "
                << test::describe(found);
            ASSERT_EQ(expected.is_hit(), occluded(tree, soup, rays[i])) << name << " ray " << i;
        }
    }
}

TEST(KdTraverse, ManyRaysACallEqualOneByOne) {
    const Soup soup = test::random_soup(5, 500, 0.1);
    const KdTree tree = build_kd_tree(soup);
    const auto rays = test::unpleasant_rays(soup, 9, 1000);
    std::vector<Hit> hits(rays.size());
    std::vector<uint8_t> shadows(rays.size());
    intersect(tree, soup, rays, {}, hits);
    occluded(tree, soup, rays, {}, shadows);
    for (size_t i = 0; i < rays.size(); ++i) {
        EXPECT_TRUE(test::same(hits[i], intersect(tree, soup, rays[i])));
        EXPECT_EQ(shadows[i] != 0, hits[i].is_hit());
    }
}

TEST(KdTraverse, SkipsTheTriangleARayStartsOn) {
    const Soup soup = test::closed_grid(16);
    const KdTree tree = build_kd_tree(soup);
    test::Random random(3);
    for (uint32_t prim = 0; prim < soup.triangle_count(); ++prim) {
        const Triangle t = soup.triangle({0, prim});
        const dvec3 outward = glm::cross(t[1] - t[0], t[2] - t[0]);
        const Ray ray{(t[0] + t[1] + t[2]) / 3.0, 0, outward + 0.1 * random.point(-1, 1) * 0.01};
        EXPECT_NE(intersect(tree, soup, ray, TriangleId{0, prim}).id, (TriangleId{0, prim}));
    }
}

TEST(KdTraverse, TiesGoToTheSmallerId) {
    std::vector<vec3> corners;
    for (int i = 0; i < 50; ++i)
        corners.insert(corners.end(), {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)});
    const Soup soup = test::one_chunk(corners);
    const Hit hit = intersect(build_kd_tree(soup), soup, Ray{{0.2, 0.2, 1}, 0, {0, 0, -1}});
    EXPECT_EQ(hit.id, (TriangleId{0, 0}));
    EXPECT_EQ(hit.t, 1);
}

/// Lets every other prim of mesh 0 count.
class EvenPrims final : public HitFilter {
public:
    bool keep(std::span<const uint64_t>, std::span<const Hit> hits,
              std::span<uint8_t> keep) override {
        for (size_t i = 0; i < hits.size(); ++i)
            keep[i] = hits[i].id.prim % 2 == 0;
        return true;
    }
};

TEST(KdTraverse, PassesByHitsThatDoNotCount) {
    Soup soup; // prims 1, 0 and 2 of mesh 0 in one place, and mesh 1 before them
    const std::vector<vec3> one = {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)};
    std::vector<vec3> three = one;
    for (const float larger : {2.0f, 3.0f})
        for (const vec3& corner : one)
            three.push_back(larger * corner);
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(three)));
    soup.chunks.push_back(Chunk::owning(dvec3(0, 0, 0.5), one));
    soup.chunks[1].set_mask(4);
    const KdTree tree = build_kd_tree(soup);
    const Ray ray{{0.2, 0.2, 1}, 0, {0, 0, -1}};
    const auto nearest = [&](const Exclusion& without, const RaySieve& sieve) {
        EXPECT_EQ(occluded(tree, soup, ray, without, sieve),
                  intersect(tree, soup, ray, without, sieve).is_hit());
        return intersect(tree, soup, ray, without, sieve).id;
    };
    EvenPrims even;
    EXPECT_EQ(nearest({}, {}), (TriangleId{1, 0}));
    EXPECT_EQ(nearest({}, {.mask = 4}), (TriangleId{1, 0}));
    EXPECT_EQ(nearest({}, {.mask = 3}), (TriangleId{0, 0}));
    EXPECT_EQ(nearest(TriangleId{0, 0}, {.mask = 3}), (TriangleId{0, 1}));
    EXPECT_EQ(nearest(TriangleId{0, 0}, {.mask = 3, .filter = &even}), (TriangleId{0, 2}));
    const Hit second = intersect(tree, soup, ray, {}, {.mask = 3, .filter = &even});
    EXPECT_EQ(nearest({{}, HitPlace(second)}, {.mask = 3, .filter = &even}), (TriangleId{0, 2}));
    EXPECT_EQ(nearest({TriangleId{0, 2}, HitPlace(second)}, {.mask = 3, .filter = &even}),
              TriangleId());
}

} // namespace
} // namespace ovc
