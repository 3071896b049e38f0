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
    double size;     // of triangles
    double distance; // of origins
    double bits;     // of corners: multiples of 1 / bits
    double at_least; // share of hits that are known
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

void put(HitLanes::Vec& to, int lane, const dvec3& v) {
    for (int axis = 0; axis < 3; ++axis)
        to[axis][lane] = v[axis];
}

/// asked: the lanes before round_hits() made `answered` of them.
void expect_every_way_alike(const HitLanes& asked, const HitLanes& answered) {
    for (const RoundHits way : ways_to_round_hits()) {
        HitLanes again = asked;
        way(again);
        for (int lane = 0; lane < HitLanes::kCount; ++lane) {
            ASSERT_EQ(again.known[lane] != 0, answered.known[lane] != 0);
            if (!again.known[lane])
                continue;
            ASSERT_EQ(again.t[lane], answered.t[lane]);
            ASSERT_EQ(again.u[lane], answered.u[lane]);
            ASSERT_EQ(again.v[lane], answered.v[lane]);
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
    };
    for (const Case& c : cases) {
        size_t hits = 0, known = 0;
        for (uint64_t seed = 0; seed < 200; ++seed) {
            RandomPoints random(seed);
            HitLanes lanes;
            std::vector<test::ExactHit> truths;
            for (int lane = 0; lane < HitLanes::kCount; ++lane) {
                const Triangle t{c.size * random.point(c.bits), c.size * random.point(c.bits),
                                 c.size * random.point(c.bits)};
                Ray ray{c.distance * random.point(c.bits), 0, dvec3(0)};
                ray.dir = 0.25 * t[0] + 0.25 * t[1] + 0.5 * t[2] - ray.org;
                const auto truth = ray.valid() ? test::exact_hit(ray, t) : std::nullopt;
                truths.push_back(truth.value_or(test::ExactHit{}));
                put(lanes.a, lane, t[0]);
                put(lanes.b, lane, t[1]);
                put(lanes.c, lane, t[2]);
                put(lanes.org, lane, ray.org);
                put(lanes.dir, lane, ray.dir);
            }
            SCOPED_TRACE(testing::Message() << c.name << " seed " << seed);
            const HitLanes asked = lanes;
            round_hits(lanes);
            expect_every_way_alike(asked, lanes);
            for (int lane = 0; lane < HitLanes::kCount; ++lane) {
                const test::ExactHit& truth = truths[size_t(lane)];
                if (truth.id.mesh == kNone)
                    continue;
                ++hits;
                if (!lanes.known[lane])
                    continue;
                ++known;
                const Hit expected = truth.rounded();
                ASSERT_EQ(lanes.t[lane], expected.t) << c.name << " seed " << seed;
                ASSERT_EQ(lanes.u[lane], expected.u) << c.name << " seed " << seed;
                ASSERT_EQ(lanes.v[lane], expected.v) << c.name << " seed " << seed;
            }
        }
        EXPECT_GT(hits, 300u) << c.name;
        EXPECT_GE(double(known), c.at_least * double(hits)) << c.name;
    }
}

} // namespace
} // namespace ovc
