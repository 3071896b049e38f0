// SPDX-License-Identifier: Apache-2.0
// Which leaves are worth moving in: most rays a byte first, short queues later or never.
#include "plugin/two_level/waiting.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

std::vector<uint32_t> wanted(const std::vector<size_t>& counts,
                             const std::vector<uint64_t>& costs) {
    return worth_moving(counts, costs, kBytesARay);
}

TEST(WorthMoving, MostRaysAByteComeFirst) {
    const std::vector<uint64_t> costs = {64 * kBytesARay, 8 * kBytesARay, 64 * kBytesARay};
    EXPECT_EQ(wanted({600, 100, 700}, costs), (std::vector<uint32_t>{1, 2, 0}));
    EXPECT_EQ(wanted({0, 100, 0}, costs), (std::vector<uint32_t>{1}));
    EXPECT_EQ(wanted({99, 100, 101}, costs), (std::vector<uint32_t>{1, 2}))
        << "less than an eighth of the first: its queue may grow";
}

TEST(WorthMoving, NoPageIsMovedForRaysThatDoublesAnswerSooner) {
    const std::vector<uint64_t> costs = {64 * kBytesARay, 8 * kBytesARay};
    EXPECT_EQ(wanted({63, 7}, costs), (std::vector<uint32_t>{}));
    EXPECT_EQ(wanted({64, 7}, costs), (std::vector<uint32_t>{0}));
    EXPECT_EQ(wanted({63, 8}, costs), (std::vector<uint32_t>{1}));
}

} // namespace
} // namespace ovc
