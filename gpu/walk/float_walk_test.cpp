// SPDX-License-Identifier: Apache-2.0
// What a walk in float32 names holds the answer, and what it calls certain is hit, with any
// instructions.
#include "gpu/walk/float_walk.h"

#include "gpu/page/page.h"
#include "gpu/page/top_level.h"
#include "kdtree/restart.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <span>

namespace ovc {
namespace {

/// A scene in one frame, as walks have it.
class Walked {
public:
    Walked(const Soup& soup, size_t leaves) : soup_(soup), numbers_(soup) {
        Box bounds;
        triangles_ = hittable_triangles(soup, nullptr, &bounds);
        level1_ = partition(soup, triangles_, bounds,
                            uint32_t(std::max<size_t>(triangles_.size() / leaves, 1)));
        share_frame(level1_);
        for (const Leaf& leaf : level1_.leaves)
            pages_.push_back(build_page(soup, numbers_, leaf, nullptr, {.allowed = true}));
        top_ = build_top_level(level1_, pages_, 8 * pages_.size());
    }

    const std::vector<TriangleId>& triangles() const { return triangles_; }
    /// A rounding of a coordinate in the scene's frame, in the world.
    double rounding() const { return 0x1p-24 / scene_leaf(level1_.bounds).frame.scale; }
    bool empty() const { return pages_.empty(); }
    bool has_loose_pairs() const { return std::ranges::any_of(pages_, &Page::has_loose_pairs); }
    Triangle triangle(uint32_t number) const { return soup_.triangle(numbers_.id(number)); }
    TriangleId id(uint32_t number) const { return numbers_.id(number); }

    /// Returns those of the rays that can be walked.
    std::vector<Ray> walkable(std::vector<Ray> rays) const {
        std::erase_if(rays, [&](const Ray& ray) {
            return !ray.valid() || !can_walk(level1_, PreparedRay(ray));
        });
        return rays;
    }

    /// skip: for each ray the triangle that it does not see; or empty.
    std::vector<Named> walk(FloatWalk by, std::span<const Ray> rays,
                            std::span<const TriangleId> skip, bool any_hit) const {
        std::vector<LocalRay> local;
        for (size_t i = 0; i < rays.size(); ++i) {
            LocalTime unused;
            local.push_back(local_ray(scene_leaf(level1_.bounds), rays[i],
                                      skip.empty() ? OVC_NO_TRIANGLE : numbers_.of(skip[i]),
                                      any_hit, unused));
        }
        std::vector<Named> named(rays.size());
        const WalkedTree tree{
            top_.tree.view().data(), 0, &pages_, [](const void* pages, uint32_t page) {
                return (*static_cast<const std::vector<Page>*>(pages))[page].view().data();
            }};
        by(tree, local.data(), local.size(), any_hit, named.data());
        return named;
    }

private:
    const Soup& soup_;
    const Numbering numbers_;
    std::vector<TriangleId> triangles_;
    Level1 level1_;
    std::vector<Page> pages_;
    TopLevel top_;
};

bool names(const Walked& scene, const Named& named, TriangleId id) {
    const auto is = [&](uint32_t number) { return scene.id(number) == id; };
    return (named.certain != OVC_MISS && is(named.certain)) ||
           std::any_of(named.further, named.further + named.count, is);
}

/// Expects that the answer to the ray is among what is named.
void expect_answer(const Walked& scene, const Named& named, const Ray& ray, const Hit& expected,
                   bool any_hit) {
    if (named.certain == OVC_FLAGGED)
        return;
    const bool certain = named.certain != OVC_MISS;
    if (certain) {
        const PreparedRay p(ray);
        EXPECT_TRUE(candidate(p, scene.triangle(named.certain), scene.id(named.certain)));
    }
    if (any_hit && certain)
        EXPECT_TRUE(expected.is_hit());
    else if (any_hit && expected.is_hit())
        EXPECT_GT(named.count, 0u);
    else if (expected.is_hit())
        EXPECT_TRUE(names(scene, named, expected.id));
    else
        EXPECT_FALSE(certain);
}

/// Rays that start on triangles, which they do not see, as rays of a renderer do.
struct Spawned {
    std::vector<Ray> rays;
    std::vector<TriangleId> skip;

    Spawned(const Soup& soup, std::span<const TriangleId> triangles) {
        test::Random random(83);
        for (const TriangleId id : triangles) {
            const Triangle t = soup.triangle(id);
            const double u = random(0, 0.5), v = random(0, 0.5);
            const dvec3 org = t[0] + u * (t[1] - t[0]) + v * (t[2] - t[0]);
            rays.push_back({org, 0, random.point(-1, 1)});
            skip.push_back(id);
        }
    }
};

bool same(const Named& a, const Named& b) {
    return a.certain == b.certain && a.count == b.count &&
           std::equal(a.further, a.further + a.count, b.further);
}

TEST(FloatWalk, NamesTheAnswerByAnyInstructions) {
    size_t loose = 0;
    for (const auto& [name, soup] : test::unpleasant_soups())
        for (const size_t leaves : {1, 12}) {
            const Walked scene(soup, leaves);
            if (scene.empty())
                continue;
            loose += scene.has_loose_pairs();
            const std::vector<Ray> rays = scene.walkable(test::unpleasant_rays(soup, 81, 700));
            std::vector<Named> first;
            for (const bool any_hit : {false, true})
                for (const FloatWalk by : float_walks()) {
                    SCOPED_TRACE(name);
                    const auto named = scene.walk(by, rays, {}, any_hit);
                    if (by == float_walks().front())
                        first = named;
                    for (size_t i = 0; i < rays.size(); ++i) {
                        SCOPED_TRACE(i);
                        expect_answer(scene, named[i], rays[i],
                                      test::brute_force(soup, scene.triangles(), rays[i]), any_hit);
                        EXPECT_TRUE(same(first[i], named[i]));
                    }
                }
        }
    EXPECT_GT(loose, 0u) << "no unit has triangles that share no side";
}

void expect_answers(const Walked& scene, const Soup& soup, std::span<const Ray> rays) {
    for (const bool any_hit : {false, true}) {
        const auto named = scene.walk(float_walk(), rays, {}, any_hit);
        for (size_t i = 0; i < rays.size(); ++i) {
            SCOPED_TRACE(i);
            expect_answer(scene, named[i], rays[i],
                          test::brute_force(soup, scene.triangles(), rays[i]), any_hit);
        }
    }
}

/// The rays go past sides of triangles, some roundings to either side. They would show it if the
/// bound were too small.
TEST(FloatWalk, NamesTheAnswerAtSides) {
    const Soup soup = test::random_soup(11, 1000, 0.3);
    const Walked scene(soup, 3);
    test::Random random(12);
    std::vector<Ray> rays;
    for (const TriangleId id : scene.triangles())
        for (int k = 0; k < 4; ++k) {
            const Triangle t = soup.triangle(id);
            const dvec3 on_side = t[0] + random(0, 1) * (t[1] - t[0]);
            const dvec3 from = on_side + 0.3 * random.point(-1, 1);
            const dvec3 to = on_side + 20 * scene.rounding() * random.point(-1, 1);
            rays.push_back({from, 0, to - from});
        }
    expect_answers(scene, soup, rays);
}

/// The rays begin or end some roundings before or behind a triangle.
TEST(FloatWalk, NamesTheAnswerAtTheEndsOfRays) {
    const Soup soup = test::random_soup(13, 1000, 0.3);
    const Walked scene(soup, 3);
    test::Random random(14);
    for (const double roundings : {3.0, 30.0, 3000.0}) {
        std::vector<Ray> rays;
        for (const TriangleId id : scene.triangles()) {
            const Triangle t = soup.triangle(id);
            const dvec3 inside = (t[0] + t[1] + t[2]) / 3.0;
            const dvec3 dir = glm::normalize(random.point(-1, 1));
            const double off = roundings * scene.rounding() * random(-1, 1);
            rays.push_back({inside + off * dir, 0, dir});
            rays.push_back({inside - 0.2 * dir, 0, dir, 0.2 + off});
        }
        expect_answers(scene, soup, rays);
    }
}

TEST(FloatWalk, PassesOverTheTriangleThatARayDoesNotSee) {
    const Soup soup = test::closed_grid(24);
    const Walked scene(soup, 5);
    const auto [rays, skip] = Spawned(soup, scene.triangles());
    const auto named = scene.walk(float_walk(), rays, skip, /* any_hit= */ false);
    size_t plain = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        SCOPED_TRACE(i);
        expect_answer(scene, named[i], rays[i],
                      test::brute_force(soup, scene.triangles(), rays[i], skip[i]), false);
        plain += named[i].certain != OVC_FLAGGED && named[i].count == 0;
    }
    EXPECT_GT(plain, rays.size() * 9 / 10);
}

TEST(FloatWalk, IsCertainOfMostRays) {
    const Soup soup = test::closed_grid(60);
    const Walked scene(soup, 9);
    test::Random random(82);
    std::vector<Ray> rays(5000);
    for (Ray& ray : rays) {
        ray.org = dvec3(0, 0, 4) + random.point(-1, 1);
        ray.dir = random.point(-1, 1) - ray.org;
    }
    const auto named = scene.walk(float_walk(), rays, {}, /* any_hit= */ false);
    size_t certain = 0;
    for (const Named& one : named)
        certain += one.certain != OVC_FLAGGED && one.count == 0;
    EXPECT_GT(certain, rays.size() * 98 / 100);
}

} // namespace
} // namespace ovc
