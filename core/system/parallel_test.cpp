// SPDX-License-Identifier: Apache-2.0
// Tests our loops inside tasks of a host that uses oneTBB as well.
#include "core/system/parallel.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <stdexcept>
#include <thread>
#include <vector>

namespace ovc {
namespace {

thread_local bool inside_call = false;

void work_for_a_while() {
    std::this_thread::sleep_for(std::chrono::microseconds(300));
}

/// Runs call() as a host does from many of its tasks, on more threads than cores. Returns how often
/// a thread that waited within one call was given another one; if a call holds a lock, that thread
/// would wait for itself.
template <class Call>
size_t calls_within_calls(Call&& call) {
    const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                              8);
    std::atomic<size_t> nested{0};
    oneapi::tbb::task_arena arena(8);
    arena.execute([&] {
        oneapi::tbb::parallel_for(0, 200, [&](int) {
            nested += inside_call;
            const bool before = std::exchange(inside_call, true);
            call();
            inside_call = before;
        });
    });
    return nested;
}

TEST(Parallel, AThreadThatWaitsInALoopTakesUpNoTaskOfTheHost) {
    EXPECT_EQ(
        calls_within_calls([] { parallel_for(16, 1, [](size_t, size_t) { work_for_a_while(); }); }),
        0u);
}

TEST(Parallel, NorInALoopWithinALoop) {
    EXPECT_EQ(calls_within_calls([] {
                  parallel_for(4, 1, [](size_t, size_t) {
                      parallel_for(4, 1, [](size_t, size_t) { work_for_a_while(); });
                      parallel_invoke(work_for_a_while, work_for_a_while);
                  });
              }),
              0u);
}

TEST(Parallel, NorInTheOtherForms) {
    EXPECT_EQ(calls_within_calls([] {
                  parallel_invoke(work_for_a_while, work_for_a_while);
                  parallel_reduce(
                      40000, 0,
                      [](size_t, size_t, int value) {
                          work_for_a_while();
                          return value;
                      },
                      [](int a, int) { return a; });
                  std::vector<int> numbers(5000);
                  for (size_t i = 0; i < numbers.size(); ++i)
                      numbers[i] = int(i * 7919 % 5000);
                  parallel_sort(numbers.begin(), numbers.end());
                  EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
              }),
              0u);
}

/// Runs call() in a group of tasks that its host has cancelled.
template <class Call>
void in_a_cancelled_group(Call&& call) {
    oneapi::tbb::task_group_context group;
    bool called = false;
    oneapi::tbb::parallel_for(
        0, 1,
        [&](int) {
            group.cancel_group_execution();
            call();
            called = true;
        },
        group);
    ASSERT_TRUE(called);
}

TEST(Parallel, RunsWholeWhereTheGroupAroundItIsCancelled) {
    in_a_cancelled_group([] {
        std::atomic<size_t> items{0};
        parallel_for(1000, 1, [&](size_t first, size_t last) { items += last - first; });
        EXPECT_EQ(items, 1000u);

        std::atomic<int> invoked{0};
        parallel_invoke([&] { ++invoked; }, [&] { ++invoked; });
        EXPECT_EQ(invoked, 2);
        in_forks([&](const Fork& fork) {
            fork([&] { fork([&] { ++invoked; }, [&] { ++invoked; }); }, [&] { ++invoked; });
        });
        EXPECT_EQ(invoked, 5);

        const size_t sum = parallel_reduce(
            100000, size_t(0),
            [](size_t first, size_t last, size_t value) { return value + last - first; },
            [](size_t a, size_t b) { return a + b; });
        EXPECT_EQ(sum, 100000u);

        std::vector<int> numbers(5000);
        for (size_t i = 0; i < numbers.size(); ++i)
            numbers[i] = int(i * 7919 % 5000);
        parallel_sort(numbers.begin(), numbers.end());
        EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
    });
}

/// An exception from one part of a loop must not cut short a loop within another part.
TEST(Parallel, ALoopWithinALoopRunsWholeWhereThatOneThrows) {
    const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                              4);
    for (int round = 0; round < 50; ++round) {
        std::atomic<bool> thrown{false};
        std::atomic<size_t> cut{0};
        const auto part = [&](size_t first, size_t) {
            if (first == 0) {
                work_for_a_while();
                thrown = true;
                throw std::runtime_error("enough");
            }
            while (!thrown) {
                std::atomic<size_t> items{0};
                parallel_for(100, 1, [&](size_t from, size_t to) { items += to - from; });
                cut += items != 100;
            }
        };
        EXPECT_THROW(parallel_for(2, 1, part), std::runtime_error);
        EXPECT_EQ(cut, 0u);
    }
}

#ifndef __SANITIZE_THREAD__
TEST(LoopThreads, AreAtMostSoManyAtOnce) {
    const oneapi::tbb::global_control threads(oneapi::tbb::global_control::max_allowed_parallelism,
                                              8);
    LoopThreads two(2), all(0);
    std::atomic<int> inside{0}, most{0};
    std::atomic<size_t> items{0};
    const auto part = [&](size_t first, size_t last) {
        const int now = ++inside;
        for (int before = most; before < now && !most.compare_exchange_weak(before, now);) {
        }
        work_for_a_while();
        items += last - first;
        --inside;
    };
    std::vector<std::thread> callers;
    for (int caller = 0; caller < 4; ++caller)
        callers.emplace_back([&] {
            const LoopThreads::Scope scope(two);
            EXPECT_EQ(thread_count(), 2u);
            parallel_for(100, 1, part);
            const LoopThreads::Scope inner(all);
            EXPECT_EQ(thread_count(), 8u);
        });
    for (std::thread& caller : callers)
        caller.join();
    EXPECT_EQ(items, 400u);
    EXPECT_LE(most, 2);
}
#endif

TEST(Forks, ThrowWhatOneOfThemThrows) {
    EXPECT_THROW(in_forks([](const Fork& fork) {
                     fork([&] { fork([] { throw std::runtime_error("one"); }, [] {}); }, [] {});
                 }),
                 std::runtime_error);
}

} // namespace
} // namespace ovc
