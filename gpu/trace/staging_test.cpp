// SPDX-License-Identifier: Apache-2.0
// Bytes that are written through the ring arrive, whenever a driver gets around to copying them.
#include "gpu/trace/staging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ovc {
namespace {

/// A driver that puts copies off as long as GL lets it: until a fence behind them is waited for, or
/// until it feels like it.
class LateDriver final : public StagingDriver {
public:
    LateDriver(unsigned seed, size_t bytes) : random_(seed), memory_(bytes) {}

    std::span<std::byte> memory() override { return memory_; }
    void copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) override {
        asked_.push_back({from, bytes, buffer, to});
        while (random_() % 4 == 0 && done_ < asked_.size())
            do_next();
    }
    uint64_t fence() override { return asked_.size(); }
    void wait(uint64_t fence) override {
        ++waits;
        if (is_broken)
            return;
        while (done_ < fence)
            do_next();
    }
    void finish() {
        while (done_ < asked_.size())
            do_next();
    }

    std::vector<std::vector<std::byte>> buffers{2, std::vector<std::byte>(1 << 16)};
    bool is_broken = false; // says that a fence is passed when it is not
    size_t waits = 0;

private:
    struct Copy {
        size_t from, bytes;
        uint32_t buffer;
        uint64_t to;
    };

    void do_next() {
        const Copy& next = asked_[done_++];
        std::copy_n(memory_.begin() + ptrdiff_t(next.from), next.bytes,
                    buffers[next.buffer].begin() + ptrdiff_t(next.to));
    }

    std::mt19937 random_;
    std::vector<std::byte> memory_;
    std::vector<Copy> asked_;
    size_t done_ = 0;
};

/// Writes at random through a ring. Returns whether the buffers are then what they should be.
bool arrives(LateDriver& driver, unsigned seed) {
    std::mt19937 random(seed);
    std::vector<std::vector<std::byte>> expected = driver.buffers;
    {
        StagingRing ring(driver);
        for (int i = 0; i < 400; ++i) {
            const size_t bytes = 1 + random() % ring.max_bytes();
            const uint32_t buffer = random() % 2;
            const size_t to = random() % (expected[buffer].size() - bytes);
            const auto value = std::byte(random());
            std::fill_n(expected[buffer].begin() + ptrdiff_t(to), bytes, value);
            ring.write(bytes, buffer, to, [&](std::span<std::byte> memory) {
                ASSERT_EQ(memory.size(), bytes);
                std::ranges::fill(memory, value);
            });
        }
    }
    driver.finish();
    return driver.buffers == expected;
}

TEST(StagingRing, BytesArriveHoweverLateTheDriverCopies) {
    for (unsigned seed = 0; seed < 50; ++seed) {
        LateDriver driver(seed, 4096 + seed * 64);
        EXPECT_TRUE(arrives(driver, seed)) << "seed " << seed;
        EXPECT_GT(driver.waits, 0u);
    }
}

TEST(StagingRing, TheTestSeesADriverThatLies) {
    LateDriver driver(1, 4096);
    driver.is_broken = true;
    EXPECT_FALSE(arrives(driver, 1));
}

TEST(StagingRing, DoesNotWaitWhileThereIsRoom) {
    LateDriver driver(1, 1 << 16);
    StagingRing ring(driver);
    for (int i = 0; i < 15; ++i)
        ring.write(4096, 0, 0, [](std::span<std::byte>) {});
    EXPECT_EQ(driver.waits, 0u);
}

} // namespace
} // namespace ovc
