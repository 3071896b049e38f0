// SPDX-License-Identifier: Apache-2.0
// Fast precision: it may name another triangle, but what it names is hit as it says.
#include "plugin/two_level/test_two_level.h"

#include <set>

namespace ovc {
namespace {

using test::ok;

TEST_F(TwoLevelGl, FastPrecisionIsCloseAndFlagsNothing) {
    const Soup soup = test::closed_grid(100);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (const auto& [compute, budget] :
         {std::pair(false, 0u), std::pair(true, 0u), std::pair(false, 192u << 10),
          std::pair(true, 192u << 10)}) {
        const auto structure = build(soup, {.budget_bytes = budget,
                                            .leaf_triangles = budget > 0 ? 300u : 0u,
                                            .certify = false,
                                            .compute = compute});
        ASSERT_TRUE(structure);
        const auto rays = test::rays_from_outside(15, 5000);
        std::vector<Hit> hits(rays.size());
        ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
        size_t other = 0;
        for (size_t i = 0; i < rays.size(); ++i) {
            const Hit expected = test::brute_force(soup, ids, rays[i]);
            if (hits[i].id != expected.id) {
                ++other;
                continue;
            }
            if (!expected.is_hit())
                continue;
            EXPECT_NEAR(hits[i].t, expected.t, 1e-5);
            EXPECT_NEAR(hits[i].u, expected.u, 1e-2);
            EXPECT_NEAR(hits[i].v, expected.v, 1e-2);
        }
        EXPECT_LT(other, rays.size() / 500);
        EXPECT_EQ(structure->statistics().flagged, 0u);
        EXPECT_EQ(structure->statistics().queues > 0, budget > 0);
        std::vector<uint8_t> occluded(rays.size());
        ASSERT_TRUE(ok(structure->occluded(rays, {}, occluded)));
        for (size_t i = 0; i < rays.size(); ++i)
            EXPECT_EQ(occluded[i] != 0, hits[i].is_hit()) << "ray " << i;
    }
}

TEST_F(TwoLevelGl, FastPrecisionSeesTheFloorThatEndsTheScene) {
    std::vector<vec3> corners;
    for (int i = 0; i < 400; ++i)
        for (const vec3& v : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0), vec3(1, 0, 0),
                              vec3(1, 1, 0), vec3(0, 1, 0)})
            corners.push_back(v + vec3(float(i % 20), float(i / 20), 0));
    corners.insert(corners.end(), {vec3(0, 0, 7), vec3(1, 0, 7), vec3(0, 1, 7)});
    const Soup soup = test::one_chunk(std::move(corners));
    const auto structure = build(soup, {.certify = false});
    ASSERT_TRUE(structure);
    test::Random random(25);
    std::vector<Ray> rays(5000);
    for (Ray& ray : rays) {
        ray.org = dvec3(random(2, 18), random(2, 18), 5);
        ray.dir = dvec3(random(2, 18), random(2, 18), 0) - ray.org;
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    for (size_t i = 0; i < rays.size(); ++i) {
        ASSERT_TRUE(hits[i].is_hit()) << "ray " << i;
        ASSERT_NEAR(hits[i].t, 1, 1e-5) << "ray " << i;
    }
}

/// Expects that what the ray was answered with is a hit of the triangle that it names, to the last
/// bit, and not of `skip`.
void expect_true(const Soup& soup, const Ray& ray, const Hit& hit, TriangleId skip) {
    if (!hit.is_hit())
        return;
    EXPECT_FALSE(hit.id == skip);
    const Hit exact = test::brute_force(soup, {hit.id}, ray);
    EXPECT_EQ(exact.id, hit.id);
    EXPECT_EQ(exact.t, hit.t);
    EXPECT_EQ(exact.u, hit.u);
    EXPECT_EQ(exact.v, hit.v);
}

TEST_F(TwoLevelGl, FastHitsBehindOneAnotherAreTrueAndComeOnce) {
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const bool compute : {false, true}) {
            SCOPED_TRACE(name + (compute ? ", compute" : ", fragment"));
            const auto rays = test::unpleasant_rays(soup, 51, 300);
            const auto structure =
                build(soup, {.leaf_triangles = 40, .certify = false, .compute = compute});
            ASSERT_TRUE(structure);
            std::vector<Hit> hits(rays.size()), after(rays.size(), kBeforeAll);
            ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
            std::vector<TriangleId> skip(rays.size());
            for (size_t i = 0; i < rays.size(); i += 2)
                skip[i] = hits[i].id;
            std::vector<std::set<TriangleId>> met(rays.size());
            size_t left = 1;
            for (size_t step = 0; left > 0; ++step) {
                ASSERT_LE(step, soup.triangle_count());
                ASSERT_TRUE(ok(structure->intersect(rays, Exclusions(skip, after), hits)));
                left = 0;
                for (size_t i = 0; i < rays.size(); ++i) {
                    expect_true(soup, rays[i], hits[i], skip[i]);
                    if (!hits[i].is_hit())
                        continue;
                    ++left;
                    EXPECT_GE(hits[i].t, after[i].t);
                    EXPECT_TRUE(met[i].insert(hits[i].id).second) << "ray " << i;
                }
                after = hits;
            }
        }
}

TEST_F(TwoLevelGl, FastHitsLieWithinTheEndsOfTheRay) {
    const Soup soup = test::random_soup(55, 400, 0.3);
    const auto structure = build(soup, {.certify = false});
    ASSERT_TRUE(structure);
    test::Random random(56);
    std::vector<Ray> rays(10000);
    for (Ray& ray : rays) {
        const Triangle on = soup.triangle({0, uint32_t(random.below(400))});
        ray.org = random.point(-3, 3);
        ray.dir = 0.25 * on[0] + 0.25 * on[1] + 0.5 * on[2] - ray.org;
        (random.below(2) ? ray.t_min : ray.t_max) = 1; // there, but for a rounding
    }
    std::vector<Hit> hits(rays.size());
    ASSERT_TRUE(ok(structure->intersect(rays, {}, hits)));
    size_t at_end = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        expect_true(soup, rays[i], hits[i], {});
        at_end += hits[i].t == 1;
    }
    EXPECT_GT(at_end, 100u);
}

TEST_F(TwoLevelGl, FastRaysBehindMaskedHitsDoNotSeeWhatTheySkip) {
    Soup soup = test::random_soup(52, 400, 0.3);
    Soup other = test::random_soup(53, 400, 0.3);
    soup.chunks.push_back(std::move(other.chunks.front()));
    soup.chunks[0].set_mask(1);
    soup.chunks[1].set_mask(2);
    const auto rays = test::rays_from_outside(54, 3000);
    const std::vector<uint32_t> masks(rays.size(), 2);
    const auto structure = build(soup, {.leaf_triangles = 40, .certify = false});
    ASSERT_TRUE(structure);
    std::vector<Hit> hits(rays.size());
    Exclusions without;
    without.sieves.masks = masks;
    ASSERT_TRUE(ok(structure->intersect(rays, without, hits)));
    std::vector<TriangleId> skip;
    for (const Hit& hit : hits)
        skip.push_back(hit.id);
    without.skip = skip;
    ASSERT_TRUE(ok(structure->intersect(rays, without, hits)));
    size_t second = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        expect_true(soup, rays[i], hits[i], skip[i]);
        second += hits[i].is_hit();
        EXPECT_TRUE(!hits[i].is_hit() || hits[i].id.mesh == 1);
    }
    EXPECT_GT(second, 100u);
}

} // namespace
} // namespace ovc
