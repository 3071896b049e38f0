// SPDX-License-Identifier: Apache-2.0
// TurnOrder: one at a time, in order where that is asked for, and nobody waits for who has left.
#include "core/system/turn_order.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <random>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace ovc {
namespace {

/// Lets workers take so many turns each, with pauses of any length between. Returns their
/// numbers in the order of their turns.
std::string turns_of(TurnOrder& order, const std::vector<size_t>& counts) {
    std::string taken;
    std::atomic<int> inside{0};
    std::vector<std::thread> threads;
    for (size_t worker = 0; worker < counts.size(); ++worker)
        threads.emplace_back([&, worker] {
            const TurnOrder::Seat seat(order, worker);
            std::mt19937 random{uint32_t(worker)};
            for (size_t i = 0; i < counts[worker]; ++i) {
                std::this_thread::sleep_for(std::chrono::microseconds(random() % 300));
                order.take(worker, [&] {
                    EXPECT_EQ(++inside, 1);
                    taken += char('0' + worker);
                    --inside;
                });
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    return taken;
}

TEST(TurnOrder, InOrderEachWaitsForTheOneBefore) {
    for (int round = 0; round < 20; ++round) {
        TurnOrder order(3, true);
        EXPECT_EQ(turns_of(order, {5, 2, 3}), "0120120200");
    }
}

TEST(TurnOrder, OtherwiseTheyComeOneAtATime) {
    TurnOrder order(3, false);
    std::string taken = turns_of(order, {50, 20, 30});
    std::ranges::sort(taken);
    EXPECT_EQ(taken, std::string(50, '0') + std::string(20, '1') + std::string(30, '2'));
}

TEST(TurnOrder, NobodyWaitsForWhoLeavesOrThrows) {
    TurnOrder order(3, true);
    order.leave(1);
    EXPECT_THROW(order.take(0, []() -> int { throw std::runtime_error("no"); }),
                 std::runtime_error);
    EXPECT_EQ(order.take(2, [] { return 7; }), 7);
    order.leave(2);
    EXPECT_EQ(order.take(0, [] { return 1; }) + order.take(0, [] { return 2; }), 3);
}

} // namespace
} // namespace ovc
