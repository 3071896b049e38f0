// SPDX-License-Identifier: Apache-2.0
// Compares cull() with rational arithmetic, and RayCull with triangles offered one by one.
#include "core/lanes/cull_batch.h"

#include "tests/exact.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <functional>
#include <limits>
#include <random>
#include <vector>

namespace ovc {
namespace {

class RandomRays {
public:
    explicit RandomRays(uint64_t seed) : engine_(seed) {}
    double uniform(double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(engine_);
    }
    uint32_t below(uint32_t count) { return uint32_t(engine_() % count); }
    /// Returns a point in a cube; its coordinates are multiples of 1 / bits.
    dvec3 point(double bits = 0x1p53) {
        const dvec3 p(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1));
        return glm::round(p * bits) / bits;
    }

private:
    std::mt19937_64 engine_;
};

/// Triangles that meet at or near a point, and lines to it.
struct CullCase {
    const char* name;
    std::function<Triangle(RandomRays&)> triangle;
    dvec3 target{0.125, 0.25, 0.375};
    double distance = 5;
    double max_offered = 0.1; // of many triangles; 1: no promise
};

Triangle round_the_target(RandomRays& random, const std::function<double(double, double)>& z) {
    Triangle triangle;
    for (int i = 0; i < 3; ++i) {
        const double a = 2 * M_PI * i / 3;
        const double x = std::round(1024 * (8 * std::cos(a) + random.uniform(-1, 1))) / 1024;
        const double y = std::round(1024 * (8 * std::sin(a) + random.uniform(-1, 1))) / 1024;
        triangle[size_t(i)] = {x, y, z(x, y)};
    }
    return triangle;
}

Triangle scaled(Triangle triangle, double by) {
    for (dvec3& corner : triangle)
        corner *= by;
    return triangle;
}

std::vector<CullCase> planes() {
    const auto ulps = [](RandomRays& random, double of) {
        return of * double(random.below(2000)) * 0x1p-50;
    };
    return {
        {"in a plane",
         [](RandomRays& r) {
             return round_the_target(r, [](double x, double y) { return x + y; });
         }},
        {"on a floor whose height takes all bits",
         [](RandomRays& r) { return round_the_target(r, [](double, double) { return 0.3; }); },
         {0.125, 0.25, 0.3}},
        {"on the floor at 0, of both signs",
         [](RandomRays& r) {
             return round_the_target(r, [&](double x, double) { return x > 0 ? 0.0 : -0.0; });
         },
         {0.125, 0.25, 0}},
        {"an ulp apart",
         [=](RandomRays& r) {
             const double up = ulps(r, 1);
             return round_the_target(r, [=](double x, double y) { return x + y + up; });
         }},
        {"corners some ulps away from a plane",
         [=](RandomRays& r) {
             return round_the_target(r, [&](double x, double y) { return x + y + ulps(r, 1); });
         }},
        {"in a plane, where t is huge",
         [](RandomRays& r) {
             return scaled(round_the_target(r, [](double x, double y) { return x + y; }), 0x1p200);
         },
         0x1p200 * dvec3(0.125, 0.25, 0.375), 0x1p203},
        {"in a plane, tiny",
         [](RandomRays& r) {
             return scaled(round_the_target(r, [](double x, double y) { return x + y; }), 0x1p-240);
         },
         0x1p-240 * dvec3(0.125, 0.25, 0.375), 0x1p-238},
    };
}

std::vector<CullCase> points() {
    const dvec3 hub(0.1, 0.2, 0.3);
    const auto at_any_corner = [](RandomRays& r, Triangle triangle) {
        std::rotate(triangle.begin(), triangle.begin() + r.below(3), triangle.end());
        return triangle;
    };
    return {
        {"at a corner of all",
         [=](RandomRays& r) {
             return at_any_corner(r, {dvec3(0), r.point(), r.point()});
         },
         dvec3(0)},
        {"a rounding beside a corner of all",
         [=](RandomRays& r) {
             return at_any_corner(r, {hub, hub + r.point(), hub + r.point()});
         },
         hub},
        {"round a side",
         [=](RandomRays& r) {
             return at_any_corner(r, {dvec3(0, 0, 0), dvec3(0, 0, 1), r.point(0x1p20)});
         },
         {0, 0, 0.5}},
        {"copies within ulps",
         [](RandomRays& r) {
             const dvec3 corners[3] = {{-0.8, -0.8, 0.7}, {0.8, -0.8, 0.65}, {0, 0.9, 0.6}};
             Triangle triangle;
             for (size_t i = 0; i < 3; ++i)
                 triangle[i] = corners[i] + 50 * 0x1p-53 * r.point();
             return triangle;
         },
         {0, 0, 0.65}},
    };
}

/// Triangles that meet nowhere, or where exact numbers alone tell.
std::vector<CullCase> others() {
    return {
        {"in one point, which is a corner of none",
         [](RandomRays& r) {
             const dvec3 p = r.point(0x1p10);
             return Triangle{p, -p, r.point(0x1p10)};
         },
         dvec3(0), 5, 1},
        {"anywhere",
         [](RandomRays& r) {
             return Triangle{r.point(), r.point(), r.point()};
         },
         dvec3(0.1)},
        {"a lattice, with triangles that have no area",
         [](RandomRays& r) {
             return Triangle{r.point(2), r.point(2), r.point(2)};
         },
         dvec3(0), 4, 1},
        {"slivers",
         [](RandomRays& r) {
             const dvec3 a = r.point();
             return Triangle{a, -a + 1e-13 * r.point(), -0.9 * a + 1e-13 * r.point()};
         },
         dvec3(0)},
        {"from where moments are beyond all doubles",
         [](RandomRays& r) {
             return scaled({r.point(), r.point(), r.point()}, 0x1p250);
         },
         0x1p250 * dvec3(0.1), 1e250, 1},
        {"seen from beyond what doubles tell",
         [](RandomRays& r) {
             return scaled({r.point(), r.point(), r.point()}, 1e-71);
         },
         dvec3(0), 1e76, 1},
    };
}

std::vector<CullCase> all_cases() {
    std::vector<CullCase> cases = planes();
    for (const auto& more : {points(), others()})
        cases.insert(cases.end(), more.begin(), more.end());
    return cases;
}

Ray ray_to(const CullCase& one, RandomRays& random) {
    Ray ray{one.target + one.distance * (dvec3(0.1, 0.2, 1) + 0.5 * random.point()), 0, dvec3(0)};
    ray.dir = one.target - ray.org;
    if (random.below(8) == 0)
        ray.t_min = random.uniform(0.9, 1);
    return ray;
}

struct Soup64 {
    std::vector<Triangle> triangles;
    std::vector<TriangleId> ids;
};

/// Some corners are copied from other triangles, some are not finite, and ids come in any order.
Soup64 soup_of(const CullCase& one, RandomRays& random, size_t count) {
    Soup64 soup;
    for (size_t i = 0; i < count; ++i) {
        soup.triangles.push_back(one.triangle(random));
        soup.ids.push_back({random.below(3), uint32_t(i)});
        if (random.below(40) == 0)
            soup.triangles[i][random.below(3)] =
                soup.triangles[random.below(uint32_t(i) + 1)][random.below(3)];
        if (random.below(100) == 0)
            soup.triangles[i][1].y = random.below(2) ? std::numeric_limits<double>::infinity()
                                                     : std::numeric_limits<double>::quiet_NaN();
    }
    return soup;
}

bool same(const Hit& a, const Hit& b) {
    return std::memcmp(&a, &b, sizeof(Hit)) == 0;
}

CullLanes lanes_of(const Soup64& soup, size_t first) {
    CullLanes lanes;
    for (size_t lane = 0; lane < CullLanes::kCount; ++lane) {
        for (size_t i = 0; i < 3; ++i)
            for (size_t axis = 0; axis < 3; ++axis)
                lanes.corner[i][axis][lane] = soup.triangles[first + lane][i][int(axis)];
        lanes.key[lane] = key_of(soup.ids[first + lane]);
    }
    return lanes;
}

/// Fails where rational arithmetic finds triangle i to be hit before `nearest`.
void expect_lost(const Soup64& soup, size_t i, const Ray& ray,
                 const std::optional<test::ExactHit>& nearest) {
    const auto hit = test::exact_hit(ray, soup.triangles[i], soup.ids[i]);
    if (!hit)
        return;
    ASSERT_TRUE(nearest);
    ASSERT_TRUE(hit->t > nearest->t || (hit->t == nearest->t && !(hit->id < nearest->id)));
}

TEST(CullLanes, WhatIsLeftOutIsMissedOrBehindTheNearest) {
    for (const CullCase& one : all_cases())
        for (uint64_t seed = 0; seed < 40; ++seed) {
            SCOPED_TRACE(testing::Message() << one.name << " seed " << seed);
            RandomRays random(seed);
            const Soup64 soup = soup_of(one, random, 64);
            const PreparedRay p(ray_to(one, random));
            Nearest nearest(p);
            CullRay ray = cull_ray(p, one.triangle(random));
            std::optional<test::ExactHit> exactly;
            for (size_t first = 0; first < 64; first += CullLanes::kCount) {
                for (const Cull way : ways_to_cull()) {
                    CullLanes lanes = lanes_of(soup, first);
                    const uint32_t left = way(ray, lanes);
                    ASSERT_EQ(left & ~CullLanes::kAll, 0u);
                    for (size_t lane = 0; lane < CullLanes::kCount; ++lane)
                        if (!(left >> lane & 1) && is_finite(soup.triangles[first + lane][1]))
                            expect_lost(soup, first + lane, p.ray, exactly);
                }
                nearest.offer(soup.triangles[first], soup.ids[first]);
                if (!nearest.is_hit())
                    continue;
                note_hit(ray, p, nearest.best());
                exactly = test::exact_hit(p.ray, nearest.best().triangle, nearest.hit().id);
                ASSERT_TRUE(exactly);
            }
        }
}

auto putting(const Soup64& soup) {
    return [&](TriangleId id, double* to) {
        for (const dvec3& corner : soup.triangles[id.prim])
            for (int axis = 0; axis < 3; ++axis, to += CullBatch::kStride)
                *to = corner[axis];
    };
}

/// Offers all through batches to several rays. Returns the number that were offered one by one.
size_t offer_all(std::span<Nearest> nearest, std::span<RayCull> culls, const Soup64& soup) {
    size_t offered = 0;
    CullBatch batch;
    for (const TriangleId added : soup.ids) {
        batch.add(added);
        if (!batch.full() && added != soup.ids.back())
            continue;
        batch.fetch(putting(soup));
        for (size_t r = 0; r < culls.size(); ++r)
            EXPECT_FALSE(culls[r].offer_left(batch, batch.all(), [&](TriangleId id) {
                ++offered;
                nearest[r].offer(soup.triangles[id.prim], id);
                return false;
            }));
        batch.clear();
    }
    return offered;
}

TEST(RayCull, AnswersAreThoseOfOfferingOneByOne) {
    for (const CullCase& one : all_cases())
        for (uint64_t seed = 0; seed < 30; ++seed) {
            SCOPED_TRACE(testing::Message() << one.name << " seed " << seed);
            RandomRays random(seed);
            const Soup64 soup = soup_of(one, random, 500);
            std::vector<PreparedRay> rays;
            for (int r = 0; r < 3; ++r) {
                Exclusion without;
                const Ray ray = ray_to(one, random);
                if (seed % 3 == 1)
                    without.skip = soup.ids[random.below(500)];
                rays.emplace_back(ray, without);
            }
            std::vector<Nearest> apart(rays.begin(), rays.end());
            std::vector<Nearest> together(rays.begin(), rays.end());
            std::vector<RayCull> culls;
            for (size_t r = 0; r < rays.size(); ++r)
                culls.emplace_back(rays[r], together[r]);
            offer_all(together, culls, soup);
            for (size_t r = 0; r < rays.size(); ++r) {
                for (size_t i = 0; i < soup.ids.size(); ++i)
                    apart[r].offer(soup.triangles[i], soup.ids[i]);
                ASSERT_TRUE(same(apart[r].hit(), together[r].hit()));
            }
        }
}

/// Where ids fall, of all that tie each is nearer than the ones before.
TEST(RayCull, OffersFewWhereThousandsLieInTheWay) {
    for (const CullCase& one : all_cases())
        for (const bool falling : {false, true}) {
            SCOPED_TRACE(testing::Message() << one.name << (falling ? ", ids fall" : ""));
            constexpr uint32_t kCount = 6400;
            RandomRays random(/* seed= */ 3);
            Soup64 soup;
            for (uint32_t i = 0; i < kCount; ++i) {
                soup.triangles.push_back(one.triangle(random));
                soup.ids.push_back({0, i});
            }
            if (falling)
                std::reverse(soup.ids.begin(), soup.ids.end());
            Ray ray = ray_to(one, random);
            ray.t_min = 0;
            const PreparedRay p(ray);
            Nearest nearest(p);
            RayCull cull(p, nearest);
            const size_t offered = offer_all({&nearest, 1}, {&cull, 1}, soup);
            EXPECT_LE(double(offered), one.max_offered * kCount);
            std::printf("%-50s %zu of %u offered\n", one.name, offered, kCount);
        }
}

/// Small triangles are told apart from far away, though a large one is the first of them all.
TEST(RayCull, LooksFromTheSmallestTriangle) {
    RandomRays random(/* seed= */ 5);
    const auto corner = [&](double size) {
        return size * dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    };
    Soup64 soup;
    for (uint32_t i = 0; i < 640; ++i) {
        const double size = i == 0 ? 1e76 : 1e-71;
        soup.triangles.push_back({corner(size), corner(size), corner(size)});
        soup.ids.push_back({0, i});
    }
    const dvec3 org = 1e76 * dvec3(0.1, 0.2, 1);
    const PreparedRay p(Ray{org, 0, -org});
    Nearest nearest(p), apart(p);
    RayCull cull(p, nearest);
    EXPECT_LE(offer_all({&nearest, 1}, {&cull, 1}, soup), 64u);
    for (size_t i = 0; i < soup.ids.size(); ++i)
        apart.offer(soup.triangles[i], soup.ids[i]);
    EXPECT_TRUE(apart.is_hit());
    EXPECT_TRUE(same(apart.hit(), nearest.hit()));
}

TEST(RayCull, StopsWhenAnOfferSaysSo) {
    RandomRays random(/* seed= */ 4);
    const CullCase one = points().front();
    const Soup64 soup = soup_of(one, random, 64);
    const PreparedRay p(ray_to(one, random));
    Nearest nearest(p);
    CullBatch batch;
    for (uint32_t i = 0; i < 64; ++i)
        batch.add(soup.ids[i]);
    batch.fetch(putting(soup));
    size_t offered = 0;
    RayCull cull(p, nearest);
    EXPECT_TRUE(cull.offer_left(batch, batch.all(), [&](TriangleId) { return ++offered > 0; }));
    EXPECT_EQ(offered, 1u);
}

} // namespace
} // namespace ovc
