// SPDX-License-Identifier: Apache-2.0
// Tests that PathSampler is even over the samples of a pixel, and independent between pixels,
// purposes and seeds.
#include "host/shade/path_sampler.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <utility>
#include <vector>

namespace ovc {
namespace {

TEST(PathSampler, PowersOfTwoLieOneInEachBoxOfAnyShape) {
    constexpr uint32_t kLog = 8, kCount = 1 << kLog;
    for (uint32_t purpose = 0; purpose < 20; ++purpose)
        for (uint32_t log_wide = 0; log_wide <= kLog; ++log_wide) {
            const double wide = 1 << log_wide, high = kCount >> log_wide;
            std::set<std::pair<int, int>> boxes;
            for (uint32_t sample = 0; sample < kCount; ++sample) {
                const dvec2 u = PathSampler(7, 1234, sample).pair(purpose);
                ASSERT_TRUE(u.x >= 0 && u.x < 1 && u.y >= 0 && u.y < 1);
                boxes.insert({int(u.x * wide), int(u.y * high)});
            }
            EXPECT_EQ(boxes.size(), kCount) << purpose << ", " << wide << " boxes wide";
        }
}

/// Returns the correlation of two series of [0, 1) x [0, 1): the mean of products, each of mean 0
/// and variance 1.
template <class First, class Second>
double correlation(First&& first, Second&& second) {
    constexpr uint32_t kCount = 4096;
    double sum = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
        const dvec2 a = std::sqrt(12.0) * (first(i) - dvec2(0.5));
        const dvec2 b = std::sqrt(12.0) * (second(i) - dvec2(0.5));
        sum += a.x * b.x + a.y * b.y + a.x * b.y + a.y * b.x;
    }
    return sum / (4 * kCount);
}

TEST(PathSampler, PixelsPurposesAndSeedsHaveNothingToDoWithEachOther) {
    const auto of = [](uint64_t seed, uint32_t pixel, uint32_t purpose) {
        return [=](uint32_t i) { return PathSampler(seed, pixel, i).pair(purpose); };
    };
    // The mean of 4 x 4096 independent products has a sigma of 1/128.
    for (uint32_t k = 0; k < 16; ++k) {
        EXPECT_LT(std::abs(correlation(of(0, k, 3), of(0, k + 1, 3))), 5 / 128.0) << k;
        EXPECT_LT(std::abs(correlation(of(0, 9, k), of(0, 9, k + 1))), 5 / 128.0) << k;
        EXPECT_LT(std::abs(correlation(of(k, 9, 3), of(k + 1, 9, 3))), 5 / 128.0) << k;
        const auto pixels = [&](uint32_t i) { return PathSampler(k, i, 0).pair(0); };
        const auto next = [&](uint32_t i) { return PathSampler(k, i + 1, 0).pair(0); };
        EXPECT_LT(std::abs(correlation(pixels, next)), 5 / 128.0) << k;
    }
}

TEST(PathSampler, IsTheSameWheneverAsked) {
    const dvec2 once = PathSampler(1, 2, 3).pair(4);
    PathSampler(1, 2, 3).pair(5);
    EXPECT_EQ(PathSampler(1, 2, 3).pair(4), once);
    EXPECT_NE(PathSampler(uint64_t(1) << 40, 2, 3).pair(4), PathSampler(0, 2, 3).pair(4));
}

} // namespace
} // namespace ovc
