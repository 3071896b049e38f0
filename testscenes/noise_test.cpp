// SPDX-License-Identifier: Apache-2.0
// The smooth functions and random numbers that scenes are made of.
#include "testscenes/noise.h"
#include "testscenes/random.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>

namespace ovc {
namespace {

TEST(Circle, IsTheCosineAndSineToABillionth) {
    for (int i = -5000; i <= 5000; ++i) {
        const double turns = i / 1234.5;
        const dvec2 c = circle(turns);
        ASSERT_NEAR(c.x, std::cos(2 * std::numbers::pi * turns), 1e-9) << turns;
        ASSERT_NEAR(c.y, std::sin(2 * std::numbers::pi * turns), 1e-9) << turns;
    }
}

TEST(Circle, ClosesExactly) {
    for (int turn = -3; turn <= 3; ++turn)
        for (int eighth = 0; eighth < 8; ++eighth)
            EXPECT_EQ(circle(turn + eighth / 8.0), circle(eighth / 8.0)) << turn << " " << eighth;
}

TEST(SmoothStep, RunsEitherWay) {
    EXPECT_EQ(smooth_step(1, 3, 0), 0);
    EXPECT_EQ(smooth_step(1, 3, 2), 0.5);
    EXPECT_EQ(smooth_step(1, 3, 4), 1);
    EXPECT_EQ(smooth_step(3, 1, 4), 0);
    EXPECT_EQ(smooth_step(3, 1, 0), 1);
}

TEST(Noise, StaysInRangeAndIsContinuous) {
    for (uint64_t seed = 0; seed < 5000; ++seed) {
        Random random(seed);
        const dvec3 p = 100.0 * random.in_ball();
        const double here = noise(p, seed);
        EXPECT_LE(std::abs(here), 1);
        EXPECT_NEAR(noise(p + 1e-6 * random.direction(), seed), here, 1e-4) << "seed " << seed;
    }
}

TEST(Random, GivesTheSameNumbersEverywhere) {
    Random random(2006);
    EXPECT_EQ(random.bits(), 17929351226161162365u);
    EXPECT_EQ(random.bits(), 14476283973188027305u);
}

TEST(Random, IsEven) {
    Random random(7);
    double sum = 0;
    std::array<int, 10> counts{};
    for (int i = 0; i < 100000; ++i) {
        const double u = random.uniform();
        ASSERT_GE(u, 0);
        ASSERT_LT(u, 1);
        sum += u;
        ++counts[random.below(10)];
    }
    EXPECT_NEAR(sum / 100000, 0.5, 0.005);
    for (const int count : counts)
        EXPECT_NEAR(count, 10000, 400);
}

TEST(Random, StreamsOfOneSeedDiffer) {
    EXPECT_NE(Random(1, 0).bits(), Random(1, 1).bits());
    EXPECT_NE(Random(1, 2).bits(), Random(2, 1).bits());
}

} // namespace
} // namespace ovc
