// SPDX-License-Identifier: Apache-2.0
// BlockCache: bytes are those of their block, however many threads ask for however many blocks.
#include "core/file/block_cache.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <random>
#include <thread>

namespace ovc {
namespace {

constexpr uint64_t kBlockBytes = 64;

/// A block's bytes tell its number and their place.
std::byte byte_of(uint64_t block, size_t place) {
    return std::byte(block * 7 + place);
}

/// Asks for some bytes of a block. Returns whether they came, and are right.
bool ask(BlockCache& cache, uint64_t block, size_t offset, bool fails, std::atomic<int>& fills) {
    std::array<std::byte, 9> found{};
    const bool here = cache.copy(block, offset, found, [&](std::span<std::byte> to) {
        ++fills;
        for (size_t i = 0; i < to.size(); ++i)
            to[i] = fails ? std::byte(0xee) : byte_of(block, i);
        return !fails;
    });
    if (!here)
        return false;
    for (size_t i = 0; i < found.size(); ++i)
        if (found[i] != byte_of(block, offset + i))
            return false;
    return true;
}

TEST(BlockCache, ReadsABlockOnceWhileThereIsRoom) {
    BlockCache cache(kBlockBytes, 1 << 16);
    std::atomic<int> fills{0};
    for (int round = 0; round < 3; ++round)
        for (uint64_t block = 0; block < 200; ++block)
            EXPECT_TRUE(ask(cache, block, block % 50, false, fills)) << block;
    EXPECT_EQ(fills, 200);
    EXPECT_EQ(cache.hits(), 400u);
    EXPECT_EQ(cache.bytes(), 200 * kBlockBytes);
}

TEST(BlockCache, ABlockThatCouldNotBeReadIsNotHere) {
    BlockCache cache(kBlockBytes, 1 << 16);
    std::atomic<int> fills{0};
    EXPECT_FALSE(ask(cache, 3, 0, true, fills));
    EXPECT_TRUE(ask(cache, 3, 0, false, fills));
    EXPECT_EQ(fills, 2);
}

TEST(BlockCache, StaysWithinItsCapacityAndRightWhateverThreadsDo) {
    const uint64_t capacity = BlockCache::min_bytes(kBlockBytes);
    BlockCache cache(kBlockBytes, capacity);
    std::atomic<int> fills{0};
    std::vector<std::thread> threads;
    for (uint64_t seed = 0; seed < 6; ++seed)
        threads.emplace_back([&, seed] {
            std::mt19937_64 random(seed);
            for (int i = 0; i < 20000; ++i) {
                const uint64_t block = random() % 100;
                const bool fails = random() % 10 == 0;
                const int before = fills;
                const bool right = ask(cache, block, random() % 55, fails, fills);
                EXPECT_TRUE(right || (fails && fills > before));
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_LE(cache.bytes(), capacity);
    EXPECT_GT(cache.hits(), 0u);
}

} // namespace
} // namespace ovc
