// SPDX-License-Identifier: Apache-2.0
#include "importers/file/read_ahead.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>

namespace ovc {
namespace {

using Block = ReadAhead::Block;

/// Makes blocks of one byte each: 1, 2, ... `last`, then an empty one.
auto counting(int last, std::atomic<int>& calls) {
    return [&calls, last](Block& block) {
        const int number = ++calls;
        block.bytes.assign(number <= last ? 1 : 0, static_cast<unsigned char>(number));
        block.damage.clear();
    };
}

TEST(ReadAhead, GivesBlocksInOrderAndThenEmptyOnes) {
    for (const int blocks : {0, 1, 3, 4, 5, 200}) {
        std::atomic<int> calls = 0;
        ReadAhead ahead(counting(blocks, calls));
        for (int i = 1; i <= blocks; ++i) {
            const Block& block = ahead.next();
            ASSERT_EQ(block.bytes.size(), 1u) << i;
            ASSERT_EQ(block.bytes[0], i);
        }
        EXPECT_TRUE(ahead.next().bytes.empty());
        EXPECT_TRUE(ahead.next().bytes.empty()) << "and again";
        EXPECT_EQ(calls, blocks + 1) << "not read beyond the end";
    }
}

TEST(ReadAhead, KeepsABlockAsLongAsItIsUsed) {
    std::atomic<int> calls = 0;
    ReadAhead ahead(counting(50, calls));
    for (int i = 1; i <= 20; ++i) {
        const Block& block = ahead.next();
        // Wait until the thread has gone as far ahead as it may.
        while (calls < i + 3)
            std::this_thread::yield();
        ASSERT_EQ(block.bytes[0], i);
    }
}

TEST(ReadAhead, TellsDamageAfterWhatWasReadBefore) {
    int calls = 0;
    ReadAhead ahead([&](Block& block) {
        block.bytes.assign(1, static_cast<unsigned char>(++calls));
        block.damage = calls == 3 ? "cut off" : "";
    });
    for (int i = 1; i <= 3; ++i) {
        const Block& block = ahead.next();
        EXPECT_EQ(block.bytes[0], i);
        EXPECT_EQ(block.damage, i == 3 ? "cut off" : "");
    }
    EXPECT_TRUE(ahead.next().bytes.empty());
    EXPECT_EQ(calls, 3);
}

TEST(ReadAhead, ThrowsWhatReadingThrewWhereItComesTo) {
    int calls = 0;
    ReadAhead ahead([&](Block& block) {
        if (++calls == 3)
            throw std::runtime_error("no more memory");
        block.bytes.assign(1, 7);
    });
    EXPECT_EQ(ahead.next().bytes.size(), 1u);
    EXPECT_EQ(ahead.next().bytes.size(), 1u);
    EXPECT_THROW(ahead.next(), std::runtime_error);
}

TEST(ReadAhead, EndsWhereItIsNotUsedUp) {
    for (int used = 0; used < 5; ++used) {
        std::atomic<int> calls = 0;
        ReadAhead ahead(counting(1000, calls));
        for (int i = 0; i < used; ++i)
            ahead.next();
    }
}

} // namespace
} // namespace ovc
