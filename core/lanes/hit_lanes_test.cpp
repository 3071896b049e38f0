// SPDX-License-Identifier: Apache-2.0
// Compares round_hits() with rational arithmetic: known values are the exact ones, rounded.
#include "core/lanes/hit_lanes.h"

#include "tests/exact.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

struct Case {
    const char* name;
    double size;                   // of triangles
    double distance;               // of origins
    double bits;                   // of corners: multiples of 1 / bits
    double at_least;               // share of hits that are known
    dvec3 target{0.25, 0.25, 0.5}; // weights of the corners in where rays are aimed
};

class RandomPoints {
public:
    explicit RandomPoints(uint64_t seed) : engine_(seed) {}
    dvec3 point(double bits) {
        std::uniform_real_distribution<double> unit(-1, 1);
        const dvec3 p(unit(engine_), unit(engine_), unit(engine_));
        return glm::round(p * bits) / bits;
    }

private:
    std::mt19937_64 engine_;
};

/// Returns whether what is known of the lane is what the hit has.
bool is_where_known(const HitLanes& lanes, int lane, const Hit& hit) {
    const long long known = lanes.known[lane];
    return (!(known & HitLanes::kT) || lanes.t[lane] == hit.t) &&
           (!(known & HitLanes::kU) || lanes.u[lane] == hit.u) &&
           (!(known & HitLanes::kV) || lanes.v[lane] == hit.v);
}

/// asked: the lanes before round_hits() made `answered` of them.
void expect_every_way_alike(const HitLanes& asked, const HitLanes& answered) {
    for (const RoundHits way : ways_to_round_hits()) {
        HitLanes again = asked;
        way(again, HitLanes::kCount);
        for (int lane = 0; lane < HitLanes::kCount; ++lane) {
            ASSERT_EQ(again.known[lane], answered.known[lane]);
            const Hit hit{answered.t[lane], answered.u[lane], answered.v[lane], {}};
            ASSERT_TRUE(is_where_known(again, lane, hit));
        }
    }
}

TEST(HitLanes, WhatIsKnownIsTheExactValueRounded) {
    const Case cases[] = {
        {"floats", 1, 5, 0x1p20, 0.99},
        {"doubles", 1, 5, 0x1p52, 0.99},
        {"small and far away", 1e-6, 1e5, 0x1p52, 0.9},
        {"tiny", 0x1p-250, 0x1p-240, 0x1p52, 0.99},
        {"huge", 0x1p250, 0x1p250, 0x1p52, 0.99},
        {"lattice, where u or v is often 0", 1, 4, 2, 0.1},
        {"from beyond what doubled precision tells", 1e-12, 1e18, 0x1p52, 0},
        // About half of these are misses.
        {"at a side, but for a rounding", 1, 5, 0x1p52, 0.99, {0.3, 0.7, 0}},
        {"at another side", 1, 5, 0x1p52, 0.99, {0, 0.6, 0.4}},
        {"at a corner", 0.03, 5.7, 0x1p52, 0.99, {0, 0, 1}},
        {"at the first corner, far away", 1, 1e6, 0x1p52, 0.99, {1, 0, 0}},
    };
    for (const Case& c : cases) {
        size_t hits = 0, known = 0;
        for (uint64_t seed = 0; seed < 200; ++seed) {
            RandomPoints random(seed);
            HitLanes lanes;
            std::vector<test::ExactHit> truths;
            std::array<Ray, HitLanes::kCount> rays;
            for (int lane = 0; lane < HitLanes::kCount; ++lane) {
                const Triangle t{c.size * random.point(c.bits), c.size * random.point(c.bits),
                                 c.size * random.point(c.bits)};
                Ray& ray = rays[size_t(lane)];
                ray = {c.distance * random.point(c.bits), 0, dvec3(0)};
                ray.dir = c.target[0] * t[0] + c.target[1] * t[1] + c.target[2] * t[2] - ray.org;
                const auto truth = ray.valid() ? test::exact_hit(ray, t) : std::nullopt;
                truths.push_back(truth.value_or(test::ExactHit{}));
                lanes.set(lane, &ray, t);
            }
            SCOPED_TRACE(testing::Message() << c.name << " seed " << seed);
            const HitLanes asked = lanes;
            round_hits(lanes, HitLanes::kCount);
            expect_every_way_alike(asked, lanes);
            for (int lane = 0; lane < HitLanes::kCount; ++lane) {
                const test::ExactHit& truth = truths[size_t(lane)];
                if (truth.id.mesh == kNone)
                    continue;
                ++hits;
                known += lanes.known[lane] == HitLanes::kAll;
                ASSERT_TRUE(is_where_known(lanes, lane, truth.rounded()));
            }
        }
        EXPECT_GT(hits, 200u) << c.name;
        EXPECT_GE(double(known), c.at_least * double(hits)) << c.name;
    }
}

} // namespace
} // namespace ovc
