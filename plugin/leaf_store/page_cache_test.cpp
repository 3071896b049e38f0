// SPDX-License-Identifier: Apache-2.0
// PageCache: every page that comes is the right one, however many threads ask, reads fail and pages
// push each other out; and all of them together stay within the capacity.
#include "plugin/leaf_store/page_cache.h"

#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <new>

namespace ovc {
namespace {

/// Pages of several sizes, whose texels have their page's number.
struct Pages {
    std::vector<uint64_t> bytes;
    std::atomic<uint64_t> fills{0};
    std::atomic<uint32_t> failing{0};  // one fill in so many fails; 0: none
    std::atomic<uint32_t> throwing{0}; // one in so many throws

    explicit Pages(size_t count) {
        for (size_t i = 0; i < count; ++i)
            bytes.push_back(sizeof(uvec4) * (100 + 37 * i % 400));
    }
    uint64_t largest() const { return *std::ranges::max_element(bytes); }

    PageCache::Fill fill() {
        return [this](uint32_t page, std::span<std::byte> to) -> Result<Done> {
            EXPECT_EQ(to.size(), bytes[page]);
            const uint64_t number = ++fills;
            if (failing > 0 && number % failing == 0)
                return Error{"the disk fails"};
            if (throwing > 0 && number % throwing == 0)
                throw std::bad_alloc();
            const std::span texels(reinterpret_cast<uvec4*>(to.data()), to.size() / sizeof(uvec4));
            std::ranges::fill(texels, uvec4(page));
            return Done{};
        };
    }
};

bool holds(const PageCache::Pin& pin, uint32_t page) {
    return !pin.texels().empty() &&
           std::ranges::all_of(pin.texels(), [&](const uvec4& t) { return t == uvec4(page); });
}

TEST(PageCache, ReadsAPageOnceWhileThereIsRoom) {
    Pages pages(20);
    PageCache cache(pages.bytes, 1 << 20, pages.fill());
    for (int round = 0; round < 3; ++round)
        for (uint32_t page = 0; page < 20; ++page) {
            const auto pin = cache.pin(page);
            ASSERT_TRUE(pin);
            EXPECT_TRUE(holds(*pin, page));
        }
    EXPECT_EQ(pages.fills, 20u);
    EXPECT_EQ(cache.counts().misses, 20u);
    EXPECT_EQ(cache.counts().hits, 40u);
}

TEST(PageCache, ThePageUsedLeastLatelyGoes) {
    Pages pages(3);
    pages.bytes.assign(3, 1600);
    PageCache cache(pages.bytes, 3200, pages.fill());
    for (const uint32_t page : {0u, 1u, 0u, 2u})
        EXPECT_TRUE(cache.pin(page));
    EXPECT_TRUE(cache.is_here(0));
    EXPECT_FALSE(cache.is_here(1));
    EXPECT_TRUE(cache.is_here(2));
}

TEST(PageCache, StaysWithinItsCapacityWhateverThreadsDo) {
    struct {
        uint32_t failing, throwing;
    } const cases[] = {{0, 0}, {7, 0}, {0, 7}};
    for (const auto& [failing, throwing] : cases) {
        Pages pages(40);
        pages.failing = failing;
        pages.throwing = throwing;
        const uint64_t capacity = 2 * pages.largest();
        PageCache cache(pages.bytes, capacity, pages.fill());
        std::atomic<size_t> errors{0};
        std::vector<std::thread> threads;
        for (uint64_t seed = 0; seed < 6; ++seed)
            threads.emplace_back([&, seed] {
                test::Random random(seed);
                for (int i = 0; i < 2000; ++i) {
                    const auto page = uint32_t(random.below(40));
                    if (i % 10 == 0)
                        cache.read_ahead({page, (page + 1) % 40, (page + 2) % 40});
                    const auto pin = cache.pin(page);
                    if (pin)
                        EXPECT_TRUE(holds(*pin, page)) << page;
                    else
                        ++errors;
                }
            });
        for (std::thread& thread : threads)
            thread.join();
        EXPECT_LE(cache.counts().peak_bytes, capacity);
        EXPECT_EQ(errors > 0, failing + throwing > 0);
    }
}

TEST(PageCache, APageForWhichThereIsNoMemoryIsAnErrorAndCanBeReadLater) {
    Pages pages(2);
    PageCache cache(pages.bytes, 1 << 20, pages.fill());
    pages.throwing = 1;
    const auto none = cache.pin(1);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, ErrorKind::OutOfMemory);
    EXPECT_FALSE(cache.is_here(1));
    pages.throwing = 0;
    const auto pin = cache.pin(1);
    ASSERT_TRUE(pin);
    EXPECT_TRUE(holds(*pin, 1));
}

TEST(PageCache, ReadsAheadInOrderUpToHalfOfItsCapacity) {
    Pages pages(10);
    pages.bytes.assign(10, 1600);
    PageCache cache(pages.bytes, 8 * 1600, pages.fill());
    cache.read_ahead({5, 3, 7, 1, 2, 8});
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(10);
    while (cache.counts().ahead < 4 && std::chrono::steady_clock::now() < deadline)
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(cache.counts().ahead, 4u);
    for (const uint32_t page : {5u, 3u, 7u, 1u})
        EXPECT_TRUE(cache.is_here(page)) << page;
    for (const uint32_t page : {2u, 8u})
        EXPECT_FALSE(cache.is_here(page)) << page;
    EXPECT_TRUE(cache.pin(5));
    EXPECT_EQ(cache.counts().misses, 0u);
}

TEST(PageCache, WhatWasReadAheadMakesRoomForWhatIsNeeded) {
    Pages pages(10);
    pages.bytes.assign(10, 1600);
    PageCache cache(pages.bytes, 2 * 1600, pages.fill());
    for (uint32_t round = 0; round < 200; ++round) {
        cache.read_ahead({round % 10, (round + 1) % 10});
        const auto pin = cache.pin((round + 5) % 10);
        ASSERT_TRUE(pin);
        EXPECT_TRUE(holds(*pin, (round + 5) % 10));
    }
}

} // namespace
} // namespace ovc
