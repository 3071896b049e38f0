// SPDX-License-Identifier: Apache-2.0
// Compares the hits of rays at far triangles with exact arithmetic.
#include "core/lanes/far_triangle.h"

#include "tests/exact.h"
#include "tests/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

/// Returns a point whose coordinates are up to `reach`, of either sign.
dvec3 point(test::Random& random, double reach) {
    return random.point(-reach, reach);
}

dvec3 point_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

TEST(FarTriangle, TellsTheWeightsOfPointsWithinItsBounds) {
    size_t triangles = 0;
    for (uint64_t seed = 0; seed < 3000; ++seed) {
        test::Random random(seed);
        const double size = std::pow(10.0, random(-6, 8));
        const dvec3 middle = point(random, 9 * size);
        const Triangle t{middle + point(random, size), middle + point(random, size),
                         middle + point(random, size)};
        const auto far = far_triangle(t, 7);
        if (!far)
            continue;
        ++triangles;
        EXPECT_EQ(far->number, 7u);
        EXPECT_LE(far->error, 1e-6);
        const double b = random(-1, 2), c = random(-1, 2);
        const dvec3 p = b * (t[1] - t[0]) + c * (t[2] - t[0]);
        const dvec3 p_error = 0x1p-49 * (glm::abs(t[0]) + glm::abs(p));
        // Beyond the corners the error grows with the weights, and the point has its own.
        const auto expect_weight = [&](const dvec3& to, double weight) {
            EXPECT_NEAR(glm::dot(to, p), weight, 8 * far->error + glm::dot(glm::abs(to), p_error));
        };
        expect_weight(point_of(far->to_b), b);
        expect_weight(point_of(far->to_c), c);
        for (const dvec3& corner : t) {
            EXPECT_LE(far->lo, glm::dot(point_of(far->normal), corner - t[0]));
            EXPECT_GE(far->hi, glm::dot(point_of(far->normal), corner - t[0]));
        }
        EXPECT_LE(far->hi - far->lo, 1e-12 * size) << "thick for its width";
    }
    EXPECT_GT(triangles, 2900u);
}

TEST(FarTriangle, IsNotTooThin) {
    const dvec3 along(1, 1 / 3.0, 1 / 7.0);
    EXPECT_FALSE(far_triangle({dvec3(0), along, 0.7 * along + dvec3(0, 1e-12, 0)}, 0));
    EXPECT_FALSE(far_triangle({dvec3(0), along, along}, 0));
    EXPECT_FALSE(far_triangle({dvec3(0), dvec3(1e-200, 0, 0), dvec3(0, 1e-200, 0)}, 0));
}

TEST(FarTriangle, SharesThePlaneOfTheOneBefore) {
    size_t shared = 0, cases = 0;
    for (uint64_t seed = 0; seed < 1000; ++seed) {
        test::Random random(seed);
        const double size = std::pow(10.0, random(-6, 8));
        const bool level = seed % 2; // exactly in a plane
        const auto any = [&] {
            const dvec3 p = point(random, size);
            return level ? dvec3(p.x, 0, p.z) : p;
        };
        const dvec3 corner = any(), ab = any(), ac = any();
        const std::array<NumberedTriangle, 3> quad{
            {{{corner, corner + ab, corner + ac}, 0},
             {{corner + ab, corner + ab + ac, corner + ac}, 1},
             {{corner + dvec3(0, size, 0), corner + ab, corner + ac}, 2}}};
        const std::vector<FarTriangle> far = far_triangles(quad);
        if (far.size() < quad.size())
            continue;
        ++cases;
        shared += far[1].shares_plane;
        EXPECT_TRUE(far[1].shares_plane || !level);
        EXPECT_FALSE(far[0].shares_plane || far[2].shares_plane) << seed;
        for (const FarTriangle& one : far)
            for (const dvec3& at : quad[one.number].corners) {
                const test::Rational height =
                    test::dot(test::exact(point_of(one.normal)),
                              test::minus(test::exact(at), test::exact(point_of(one.a))));
                EXPECT_TRUE(height >= test::Rational(one.lo) && height <= test::Rational(one.hi));
            }
    }
    EXPECT_GT(cases, 900u);
    EXPECT_GT(shared, cases * 9 / 10);
}

/// Some triangles that reach far, through each other or side by side, and eight rays to them.
struct FarCase {
    std::vector<Triangle> triangles;
    std::vector<FarTriangle> far;
    RayLanes lanes;
    std::array<Ray, RayLanes::kCount> rays;
    std::array<uint32_t, RayLanes::kCount> skip;

    explicit FarCase(uint64_t seed) {
        test::Random random(seed);
        const double size = std::pow(10.0, random(-4, 9));
        const dvec3 middle = point(random, seed % 3 ? 0 : 1e6);
        const dvec3 corner = middle + point(random, size), ab = point(random, size),
                    ac = point(random, size);
        triangles.push_back({corner, corner + ab, corner + ac});
        if (seed % 2)
            triangles.push_back({corner + ab, corner + ab + ac, corner + ac});
        for (uint64_t more = seed % 5; more > 1; --more)
            triangles.push_back({middle + point(random, size), middle + point(random, size),
                                 middle + point(random, size)});
        std::vector<NumberedTriangle> numbered;
        for (uint32_t i = 0; i < triangles.size(); ++i)
            numbered.push_back({triangles[i], i});
        far = far_triangles(numbered);
        for (size_t lane = 0; lane < rays.size(); ++lane)
            rays[lane] = ray(random, middle, lane + seed);
        std::array<const Ray*, RayLanes::kCount> addresses;
        for (size_t lane = 0; lane < rays.size(); ++lane) {
            addresses[lane] = &rays[lane];
            skip[lane] = (lane + seed) % 11 == 4 ? uint32_t(seed % 2) : kNone;
        }
        gather(addresses.data(), lanes);
    }

    Ray ray(test::Random& random, const dvec3& middle, size_t kind) {
        const Triangle& t = triangles[kind % triangles.size()];
        const bool at_side = kind % 7 == 3, along = kind % 7 == 5;
        const double b = random(-0.2, 1.2), c = at_side ? 1 - b : random(-0.2, 1.2);
        const dvec3 aim = t[0] + b * (t[1] - t[0]) + c * (t[2] - t[0]);
        Ray ray{.org = middle + point(random, std::pow(10.0, random(-3, 3)))};
        ray.dir = along ? (t[1] - t[0]) * random(-1, 1) : aim - ray.org;
        if (kind % 7 == 4)
            ray.org = aim;
        if (kind % 7 == 2)
            ray.t_max = random(0.999, 1.001);
        if (kind % 7 == 6)
            ray.t_min = random(0.999, 1.001);
        return ray;
    }
};

/// Returns the hits of the ray with the triangles that it sees, the nearest first.
std::vector<test::ExactHit> exact_hits(const FarCase& c, size_t lane) {
    std::vector<test::ExactHit> hits;
    for (const FarTriangle& far : c.far)
        if (far.number != c.skip[lane])
            if (auto hit = test::exact_hit(c.rays[lane], c.triangles[far.number])) {
                hit->id = {0, far.number};
                hits.push_back(*hit);
            }
    std::ranges::stable_sort(hits, {}, &test::ExactHit::t);
    return hits;
}

TEST(FarTriangle, IsMetWhereExactArithmeticSaysSo) {
    size_t plain = 0, unclear = 0, hit = 0;
    for (uint64_t seed = 0; seed < 4000; ++seed) {
        SCOPED_TRACE(seed);
        const FarCase c(seed);
        std::vector<FarMeeting> meetings{meet_far(c.far, c.lanes, c.skip.data())};
        for (const MeetFar way : ways_to_meet_far())
            meetings.push_back(way(c.far, c.lanes, c.skip.data()));
        for (size_t lane = 0; lane < c.rays.size(); ++lane) {
            if (!c.rays[lane].valid())
                continue;
            const std::vector<test::ExactHit> exact = exact_hits(c, lane);
            for (const FarMeeting& met : meetings) {
                const bool is_unclear = met.unclear >> lane & 1, hits = met.hits >> lane & 1;
                if (hits) {
                    ASSERT_FALSE(exact.empty());
                    ASSERT_LE(exact.front().t, test::Rational(met.last[lane]));
                }
                if (is_unclear)
                    continue;
                ASSERT_EQ(hits, !exact.empty());
                ASSERT_TRUE(!hits || met.nearest[lane] == exact.front().id.prim);
            }
            const size_t kind = (lane + seed) % 7;
            if (kind > 1)
                continue;
            ++plain;
            unclear += meetings[0].unclear >> lane & 1;
            hit += meetings[0].hits >> lane & 1;
        }
    }
    EXPECT_GT(hit, plain / 4);
    EXPECT_LT(unclear, plain / 1000);
}

} // namespace
} // namespace ovc
