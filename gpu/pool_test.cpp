// SPDX-License-Identifier: Apache-2.0
// The pool's books: pages never overlap, never leave the pool, and the least recently used go
// first.
#include "gpu/pool.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

TEST(Residency, PagesNeverOverlapNorLeaveThePool) {
    constexpr size_t kLeaves = 40;
    constexpr uint64_t kBytes = 10000;
    test::Random random(1);
    std::vector<uint64_t> size(kLeaves);
    for (uint64_t& s : size)
        s = 64 * (1 + random.below(50));
    Residency residency(kBytes, 16, kLeaves);
    for (int step = 0; step < 5000; ++step) {
        const uint32_t leaf = uint32_t(random.below(kLeaves));
        if (residency.resident(leaf))
            residency.touch(leaf);
        else
            residency.admit(leaf, size[leaf]);
        ASSERT_TRUE(residency.resident(leaf));
        std::vector<std::pair<uint64_t, uint64_t>> ranges;
        for (uint32_t i = 0; i < kLeaves; ++i)
            if (residency.resident(i))
                ranges.push_back(
                    {residency.slot(i).offset, residency.slot(i).offset + residency.slot(i).bytes});
        std::sort(ranges.begin(), ranges.end());
        for (size_t i = 0; i + 1 < ranges.size(); ++i)
            ASSERT_LE(ranges[i].second, ranges[i + 1].first) << "step " << step;
        ASSERT_LE(ranges.back().second, kBytes);
    }
}

TEST(Residency, EvictsTheLeastRecentlyUsed) {
    Residency residency(300, 1, 4);
    residency.admit(0, 100);
    residency.admit(1, 100);
    residency.admit(2, 100);
    residency.touch(0);
    residency.admit(3, 100);
    EXPECT_TRUE(residency.resident(0));
    EXPECT_FALSE(residency.resident(1));
    EXPECT_TRUE(residency.resident(2));
}

TEST(Residency, EvictsNobodyWhereAGapIsWideEnough) {
    Residency residency(400, 1, 5);
    residency.admit(0, 100);
    residency.admit(1, 200);
    residency.admit(2, 100);
    residency.touch(0);
    residency.touch(2);
    residency.admit(3, 50); // in place of 1
    residency.admit(4, 150);
    EXPECT_TRUE(residency.resident(0));
    EXPECT_TRUE(residency.resident(2));
    EXPECT_TRUE(residency.resident(3));
    EXPECT_TRUE(residency.resident(4));
}

TEST(Residency, TakesAPageAsLargeAsThePool) {
    Residency residency(1000, 16, 3);
    residency.admit(0, 320);
    residency.admit(1, 320);
    EXPECT_EQ(residency.admit(2, 992).offset, 0u);
    EXPECT_FALSE(residency.resident(0));
    EXPECT_FALSE(residency.resident(1));
}

TEST(Ledger, KeepsThePeak) {
    Ledger ledger;
    ledger.budget = 100;
    ledger.add(60);
    ledger.remove(50);
    ledger.add(20);
    EXPECT_EQ(ledger.in_use, 30u);
    EXPECT_EQ(ledger.peak, 60u);
}

} // namespace
} // namespace ovc
