// SPDX-License-Identifier: Apache-2.0
// Residency: pages never overlap and never leave the pool, and the least recently used pages go
// first.
#include "gpu/page/residency.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

std::vector<Stretch> whole(uint64_t bytes) {
    return {{0, bytes}};
}

/// Finds room for the page, whatever pages have to go.
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
    Residency residency(whole(kBytes), 16, kLeaves);
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
    Residency residency(whole(300), 1, 4);
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
    Residency residency(whole(400), 1, 5);
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
    Residency residency(whole(1000), 16, 3);
    admit(residency, 0, 320);
    admit(residency, 1, 320);
    admit(residency, 2, 992);
    EXPECT_EQ(residency.slot(2).offset, 0u);
    EXPECT_FALSE(residency.resident(0));
    EXPECT_FALSE(residency.resident(1));
}

TEST(Residency, WhatWasUsedSinceStays) {
    Residency residency(whole(300), 1, 5);
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

TEST(Residency, NoPageLiesInTwoStretches) {
    const std::vector<Stretch> stretches{{32, 100}, {128, 228}, {256, 300}};
    Residency residency(stretches, 1, 6);
    admit(residency, 0, 60);
    admit(residency, 1, 60);
    admit(residency, 2, 40); // the gap of 8 behind 0 is too small, that behind 1 is not
    admit(residency, 3, 44);
    EXPECT_EQ(residency.slot(0).offset, 32u);
    EXPECT_EQ(residency.slot(1).offset, 128u);
    EXPECT_EQ(residency.slot(2).offset, 188u);
    EXPECT_EQ(residency.slot(3).offset, 256u);
    residency.touch(0);
    admit(residency, 4, 100); // in place of 1 and 2, which were used before the others
    EXPECT_EQ(residency.slot(4).offset, 128u);
    EXPECT_TRUE(residency.resident(0) && residency.resident(3));
}

TEST(Residency, PagesKeepTheirPlacesUnderNewNumbers) {
    Residency residency(whole(400), 1, 4);
    for (const uint32_t leaf : {0u, 1u, 3u})
        admit(residency, leaf, 100);
    residency.touch(0);
    const std::vector<uint64_t> offsets = {residency.slot(0).offset, residency.slot(1).offset,
                                           residency.slot(3).offset};
    residency.renumber(std::vector<uint32_t>{3, kNone, 0, 2, kNone}); // 1 goes
    EXPECT_EQ(residency.resident_count(), 2u);
    EXPECT_EQ(residency.slot(0).offset, offsets[2]);
    EXPECT_EQ(residency.slot(2).offset, offsets[0]);
    for (const uint32_t leaf : {1u, 3u, 4u})
        EXPECT_FALSE(residency.resident(leaf));
    admit(residency, 1, 100);
    EXPECT_EQ(residency.slot(1).offset, offsets[1]) << "where the page that went has been";
    admit(residency, 3, 100);
    admit(residency, 4, 100);
    EXPECT_FALSE(residency.resident(0)) << "it was used longest ago";
    EXPECT_TRUE(residency.resident(2));
}

TEST(Residency, WhatIsTakenOutLeavesItsPlace) {
    Residency residency(whole(200), 1, 3);
    admit(residency, 0, 100);
    admit(residency, 1, 100);
    const uint64_t offset = residency.slot(0).offset;
    residency.evict(0);
    EXPECT_FALSE(residency.resident(0));
    EXPECT_EQ(residency.resident_count(), 1u);
    admit(residency, 2, 100);
    EXPECT_EQ(residency.slot(2).offset, offset);
    EXPECT_TRUE(residency.resident(1));
}

TEST(PoolLayout, NumbersOfUnitsHaveTheBuffersAbove) {
    const PoolLayout one{3 << 20, 3 << 20};
    EXPECT_EQ(one.count(), 1u);
    EXPECT_EQ(one.buffer_bits(), uint32_t(OVC_MAX_BUFFER_BITS));
    const PoolLayout three{7 << 20, 3 << 20}; // 49,152 units a buffer: 16 bits
    EXPECT_EQ(three.count(), 3u);
    EXPECT_EQ(three.bytes_of(1), uint64_t(3 << 20));
    EXPECT_EQ(three.bytes_of(2), uint64_t(1 << 20));
    EXPECT_EQ(three.buffer_bits(), 16u);
    EXPECT_EQ(three.begin_of(2), uint64_t(2 * 65536 * OVC_UNIT_BYTES));
    EXPECT_EQ(three.buffer_of(three.begin_of(2)), 2u);
    EXPECT_EQ(three.buffer_of(three.begin_of(2) - OVC_UNIT_BYTES), 1u);
}

TEST(PoolLayout, LargePoolsAreCountedToo) {
    const PoolLayout layout{uint64_t(100) << 30, uint64_t(2) << 30};
    EXPECT_EQ(layout.count(), 50u);
    EXPECT_EQ(layout.buffer_bits(), 25u);
    EXPECT_EQ(layout.begin_of(49), uint64_t(98) << 30);
}

} // namespace
} // namespace ovc
