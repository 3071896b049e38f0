// SPDX-License-Identifier: Apache-2.0
// Tests which choice dominates which.
#include "host/report/page/frontier.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(Frontier, HasTheFastestAndTheRightest) {
    const std::vector<Choice> choices = {
        {1.0, {10, 0.1}}, {2.0, {0, 0}}, {3.0, {0, 0}}, {1.5, {20, 0.1}}, {4.0, {5, 0.05}}};
    EXPECT_EQ(dominating(choices, 0), std::nullopt);
    EXPECT_EQ(dominating(choices, 1), std::nullopt);
    EXPECT_EQ(dominating(choices, 2), 1u);
    EXPECT_EQ(dominating(choices, 3), 0u);
    EXPECT_EQ(dominating(choices, 4), 1u);
}

TEST(Frontier, EveryErrorCounts) {
    const std::vector<Choice> choices = {{1.0, {0, 0.2}}, {2.0, {1, 0.1}}};
    EXPECT_EQ(dominating(choices, 1), std::nullopt);
}

TEST(Frontier, TimesThatAreCloseAreTheSame) {
    const std::vector<Choice> same = {{1.0, {3}}, {1.0 + 0.9 * kSameTime, {3}}};
    EXPECT_EQ(dominating(same, 1), std::nullopt);
    const std::vector<Choice> slower = {{1.0, {3}}, {1.0 + 1.2 * kSameTime, {3}}};
    EXPECT_EQ(dominating(slower, 1), 0u);
    const std::vector<Choice> wronger = {{1.0, {3}}, {1.0, {4}}};
    EXPECT_EQ(dominating(wronger, 1), 0u);
    EXPECT_EQ(dominating(wronger, 0), std::nullopt);
}

TEST(Frontier, NamesTheFastestOfSeveral) {
    const std::vector<Choice> choices = {{2.0, {0}}, {1.0, {0}}, {9.0, {1}}};
    EXPECT_EQ(dominating(choices, 2), 1u);
}

} // namespace
} // namespace ovc
