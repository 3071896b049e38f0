// SPDX-License-Identifier: Apache-2.0
#include "gpu/budget/shared_budget.h"

#include <gtest/gtest.h>

#include <atomic>
#include <memory>
#include <optional>
#include <thread>

namespace ovc {
namespace {

using Use = SharedBudget::Use;

bool go_on() {
    return true;
}

/// A scene that allocates what its share allows.
struct User {
    User(SharedBudget& budget, uint64_t min, uint64_t max)
        : share(budget, [this] { closed += allocated.exchange(0) > 0; }) {
        share.demand(min, max);
    }
    Result<Use> begin() {
        Result<Use> use = share.begin(go_on);
        if (use)
            allocated = share.bytes();
        return use;
    }
    uint64_t use() { // returns what it had meanwhile
        const Result<Use> use = begin();
        EXPECT_TRUE(use);
        return allocated;
    }

    std::atomic<uint64_t> allocated{0};
    int closed = 0;
    SharedBudget::Share share; // closes before the rest goes
};

TEST(SharedBudget, WithoutALimitEverybodyGetsAll) {
    SharedBudget budget(0);
    User a(budget, 10, 1000), b(budget, 10, 500);
    EXPECT_EQ(a.use(), 1000u);
    EXPECT_EQ(b.use(), 500u);
    EXPECT_EQ(a.closed, 0);
}

TEST(SharedBudget, SmallSharesAreWholeAndLargeOnesEqual) {
    SharedBudget budget(100);
    User small(budget, 1, 10), large(budget, 1, 70), larger(budget, 1, 1000);
    EXPECT_EQ(small.use(), 10u);
    EXPECT_EQ(large.use(), 45u);
    EXPECT_EQ(larger.use(), 45u);
    for (User* user : {&small, &large, &larger, &small}) {
        user->use();
        EXPECT_EQ(user->closed, 0) << "now nobody is in anybody's way";
    }
}

TEST(SharedBudget, TheLongestUnusedMakesRoomForNewcomers) {
    SharedBudget budget(100);
    User first(budget, 20, 60), second(budget, 20, 40);
    EXPECT_EQ(first.use(), 60u);
    EXPECT_EQ(second.use(), 40u);
    {
        User third(budget, 20, 60);
        EXPECT_EQ(third.use(), 33u);
        EXPECT_EQ(first.closed, 1);
        EXPECT_EQ(second.closed, 0);
        EXPECT_EQ(first.use(), 33u);
        EXPECT_EQ(second.closed, 1) << "it had more than its part";
        EXPECT_EQ(third.closed, 0);
        EXPECT_EQ(second.use(), 33u);
    }
    EXPECT_EQ(first.use(), 60u) << "what another leaves is used";
    EXPECT_EQ(second.use(), 40u);
}

TEST(SharedBudget, ThoseWhoNeedMoreThanThereIsTakeTurns) {
    SharedBudget budget(100);
    User a(budget, 60, 80), b(budget, 70, 90);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(a.use(), 60u);
        EXPECT_EQ(b.allocated, 0u);
        EXPECT_EQ(b.use(), 70u);
        EXPECT_EQ(a.allocated, 0u);
    }
}

TEST(SharedBudget, AThreadThatIsInItsOwnWayIsTold) {
    SharedBudget budget(100);
    User a(budget, 60, 80), b(budget, 60, 80), c(budget, 10, 40);
    const Result<Use> outer = a.begin();
    ASSERT_TRUE(outer);
    EXPECT_EQ(c.use(), 10u) << "there is room, but not for all of them to have more";
    const Result<Use> inner = b.begin();
    ASSERT_FALSE(inner);
    EXPECT_EQ(inner.error().kind, ErrorKind::OverBudget);
}

TEST(SharedBudget, TwoThreadsInEachOthersWayAreTold) {
    SharedBudget budget(100);
    User a(budget, 50, 50), b(budget, 50, 50), c(budget, 60, 60), d(budget, 60, 60);
    std::atomic<int> inside{0}, refused{0};
    const auto work = [&](User& outer, User& inner) {
        {
            const Result<Use> use = outer.begin();
            ASSERT_TRUE(use);
            for (++inside; inside < 2;)
                std::this_thread::yield();
            refused += !inner.begin();
        }
    };
    std::thread other([&] { work(b, d); });
    work(a, c);
    other.join();
    EXPECT_GE(refused, 1); // when one has ended, the other may go on
}

TEST(SharedBudget, WaitingIsCancelled) {
    SharedBudget budget(100);
    User a(budget, 60, 80), b(budget, 60, 80);
    const Result<Use> outer = a.begin();
    std::thread([&] {
        int asked = 0;
        const Result<Use> use = b.share.begin([&] { return ++asked < 3; });
        ASSERT_FALSE(use);
        EXPECT_EQ(use.error().kind, ErrorKind::Cancelled);
    }).join();
}

/// Many threads, more than fit: nobody starves, and there is never more than the budget.
TEST(SharedBudget, IsNeverExceeded) {
    constexpr int kUsers = 6, kUses = 300;
    SharedBudget budget(100);
    std::vector<std::unique_ptr<User>> users;
    for (int i = 0; i < kUsers; ++i)
        users.push_back(std::make_unique<User>(budget, 15 + 5 * i, 100));
    std::atomic<uint64_t> in_use{0};
    std::vector<std::thread> threads;
    for (const auto& user : users)
        threads.emplace_back([&] {
            for (int i = 0; i < kUses; ++i) {
                const Result<Use> use = user->begin();
                ASSERT_TRUE(use);
                const uint64_t bytes = user->allocated;
                EXPECT_LE(in_use += bytes, 100u);
                std::this_thread::yield();
                EXPECT_EQ(user->allocated, bytes) << "nobody takes it away meanwhile";
                in_use -= bytes;
            }
        });
    for (std::thread& thread : threads)
        thread.join();
}

TEST(SharedBudget, AThreadLearnsThatItWaitsForOneThatWaitsForIt) {
    SharedBudget budget(100);
    User mine(budget, 60, 60), others(budget, 60, 60);
    std::optional<Result<Use>> use(mine.begin());
    const SharedBudget::Waiting waiting(budget);
    EXPECT_FALSE(waiting.is_in_vain(std::this_thread::get_id())) << "nobody wants room";
    std::atomic<bool> goes_on{true};
    std::thread other([&] { EXPECT_FALSE(others.share.begin([&] { return goes_on.load(); })); });
    while (!waiting.is_in_vain(other.get_id()))
        std::this_thread::yield();
    EXPECT_FALSE(waiting.is_in_vain(std::thread::id())) << "a thread that does not wait";
    others.share.demand(40, 60); // as after an update
    EXPECT_FALSE(waiting.is_in_vain(other.get_id())) << "there is room for it now";
    others.share.demand(60, 60);
    goes_on = false;
    other.join();
    use.reset();
}

} // namespace
} // namespace ovc
