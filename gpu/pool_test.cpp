// SPDX-License-Identifier: Apache-2.0
// The pool's books: pages never overlap, never leave the pool, and the least recently used go
// first.
#include "gpu/pool.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

/// Room for the page, whoever has to go.
void admit(Residency& residency, uint32_t leaf, uint64_t bytes) {
    std::vector<uint32_t> evicted;
    ASSERT_TRUE(residency.admit(leaf, bytes, residency.now(), evicted));
    for (const uint32_t gone : evicted)
        ASSERT_FALSE(residency.resident(gone));
}

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
            admit(residency, leaf, size[leaf]);
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
    admit(residency, 0, 100);
    admit(residency, 1, 100);
    admit(residency, 2, 100);
    residency.touch(0);
    admit(residency, 3, 100);
    EXPECT_TRUE(residency.resident(0));
    EXPECT_FALSE(residency.resident(1));
    EXPECT_TRUE(residency.resident(2));
}

TEST(Residency, EvictsNobodyWhereAGapIsWideEnough) {
    Residency residency(400, 1, 5);
    admit(residency, 0, 100);
    admit(residency, 1, 200);
    admit(residency, 2, 100);
    residency.touch(0);
    residency.touch(2);
    admit(residency, 3, 50); // in place of 1
    admit(residency, 4, 150);
    EXPECT_TRUE(residency.resident(0));
    EXPECT_TRUE(residency.resident(2));
    EXPECT_TRUE(residency.resident(3));
    EXPECT_TRUE(residency.resident(4));
}

TEST(Residency, TakesAPageAsLargeAsThePool) {
    Residency residency(1000, 16, 3);
    admit(residency, 0, 320);
    admit(residency, 1, 320);
    admit(residency, 2, 992);
    EXPECT_EQ(residency.slot(2).offset, 0u);
    EXPECT_FALSE(residency.resident(0));
    EXPECT_FALSE(residency.resident(1));
}

TEST(Residency, WhatWasUsedSinceStays) {
    Residency residency(300, 1, 5);
    admit(residency, 0, 100);
    const uint64_t keep = residency.now();
    admit(residency, 1, 100);
    admit(residency, 2, 100);
    std::vector<uint32_t> evicted;
    EXPECT_TRUE(residency.admit(3, 100, keep, evicted));
    EXPECT_EQ(evicted, std::vector<uint32_t>{0});
    EXPECT_FALSE(residency.admit(4, 100, keep, evicted));
    EXPECT_EQ(evicted.size(), 1u);
    EXPECT_TRUE(residency.resident(1) && residency.resident(2) && residency.resident(3));
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
