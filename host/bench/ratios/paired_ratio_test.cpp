// SPDX-License-Identifier: Apache-2.0
#include "host/bench/ratios/paired_ratio.h"

#include <gtest/gtest.h>

#include <numeric>
#include <random>
#include <vector>

namespace ovc {
namespace {

TEST(PairedRatio, IsTheMedianOfTheTurns) {
    const std::vector<double> over = {2, 30, 4, 12}, under = {1, 10, 4, 2}; // 2, 3, 1, 6
    const auto ratio = paired_ratio(over, under);
    ASSERT_TRUE(ratio);
    EXPECT_DOUBLE_EQ(ratio->median, 2.5);
    EXPECT_DOUBLE_EQ(ratio->low, 1);
    EXPECT_DOUBLE_EQ(ratio->high, 6);
}

TEST(PairedRatio, LeavesOutOrderStatisticsAsTheBinomialAllows) {
    // The numbers of values left out at each end for a probability of 90 %, from tables.
    for (const auto& [count, out] :
         {std::pair(1, 0), {4, 0}, {5, 0}, {7, 0}, {8, 1}, {10, 1}, {11, 2}, {15, 3}, {25, 7}}) {
        std::vector<double> over(static_cast<size_t>(count)), under(over.size(), 1);
        std::iota(over.begin(), over.end(), 1);
        const auto ratio = paired_ratio(over, under);
        ASSERT_TRUE(ratio);
        EXPECT_EQ(ratio->low, 1 + out) << count;
        EXPECT_EQ(ratio->high, count - out) << count;
    }
}

TEST(PairedRatio, HoldsTheMedianAsOftenAsItSays) {
    std::mt19937_64 engine(5);
    std::exponential_distribution<double> noise(1);
    const double median = std::log(2.0);
    for (const size_t count : {5, 15}) {
        size_t held = 0;
        constexpr size_t kTrials = 4000;
        for (size_t trial = 0; trial < kTrials; ++trial) {
            std::vector<double> over(count), under(count, 1);
            for (double& x : over)
                x = noise(engine);
            const auto ratio = paired_ratio(over, under);
            held += ratio->low <= median && median <= ratio->high;
        }
        EXPECT_GT(held, kTrials * 90 / 100) << count;
        EXPECT_LT(held, kTrials * 99 / 100) << count;
    }
}

TEST(PairedRatio, NeedsAsManyTimesOfBoth) {
    const std::vector<double> two = {1, 2}, three = {1, 2, 3}, zero = {0, 1};
    EXPECT_FALSE(paired_ratio({}, {}));
    EXPECT_FALSE(paired_ratio(two, three));
    EXPECT_FALSE(paired_ratio(two, zero));
}

} // namespace
} // namespace ovc
