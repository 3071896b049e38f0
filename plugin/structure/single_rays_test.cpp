// SPDX-License-Identifier: Apache-2.0
// Gathering: every ray is answered once, whatever the threads do; and the choice of the faster way,
// under a clock of the test's own.
#include "plugin/structure/faster_by_turns.h"
#include "plugin/structure/faster_way.h"
#include "plugin/structure/single_rays.h"

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <thread>
#include <vector>

namespace ovc {
namespace {

/// asked(i, ray) from 64 threads, 100 rays each; returns how many were answered.
template <class Trace>
size_t answered_of_6400(Gathering<SingleRay>& gathering, Trace&& trace) {
    std::atomic<size_t> right{0};
    std::vector<std::thread> threads;
    for (int t = 0; t < 64; ++t)
        threads.emplace_back([&, t] {
            for (int i = 0; i < 100; ++i) {
                SingleRay ray;
                ray.ray.t_min = t * 100 + i;
                right += gathering.answer(ray, trace) && ray.hit.t == ray.ray.t_min;
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    return right;
}

TEST(Gathering, AnswersEveryRayInOneBatch) {
    Gathering<SingleRay> gathering;
    size_t batches = 0, rays = 0;
    std::atomic<int> at_once{0};
    EXPECT_EQ(answered_of_6400(gathering,
                               [&](std::span<SingleRay* const> batch) {
                                   EXPECT_EQ(++at_once, 1) << "one batch at a time";
                                   EXPECT_FALSE(batch.empty());
                                   ++batches;
                                   rays += batch.size();
                                   for (SingleRay* ray : batch)
                                       ray->hit.t = ray->ray.t_min;
                                   std::this_thread::sleep_for(std::chrono::microseconds(50));
                                   --at_once;
                                   return true;
                               }),
              6400u);
    EXPECT_EQ(rays, 6400u);
    EXPECT_LT(batches, rays / 4) << "they come together";
}

TEST(Gathering, WhatCannotBeTracedIsRefusedToEachAndNothingIsLost) {
    Gathering<SingleRay> gathering;
    size_t batches = 0;
    const size_t answered = answered_of_6400(gathering, [&](std::span<SingleRay* const> batch) {
        if (++batches % 3 == 0)
            return false;
        if (batches % 3 == 1)
            throw std::runtime_error("no memory");
        for (SingleRay* ray : batch)
            ray->hit.t = ray->ray.t_min;
        return true;
    });
    EXPECT_GT(answered, 0u);
    EXPECT_LT(answered, 6400u);
}

/// A host with one thread: a call takes as long as its way does, the host itself a millisecond.
struct Simulation {
    static inline FasterWay::Time now;

    /// Calls until so many seconds have passed; returns the share by way 1.
    double run(double seconds, std::chrono::microseconds way0, std::chrono::microseconds way1) {
        const FasterWay::Time end = now + std::chrono::duration_cast<FasterWay::Clock::duration>(
                                              std::chrono::duration<double>(seconds));
        size_t calls = 0, by_way1 = 0;
        while (now < end) {
            const FasterWay::Use use = way.begin([] { return now; });
            now += use.way == 0 ? way0 : way1;
            way.end(use, true, [] { return now; });
            now += std::chrono::milliseconds(1);
            ++calls;
            by_way1 += size_t(use.way == 1);
        }
        return double(by_way1) / double(calls);
    }

    FasterWay way;
};

using std::chrono::microseconds;

TEST(FasterWay, StaysWithTheFirstWhereTheSecondIsSlower) {
    Simulation simulation;
    Simulation::now = FasterWay::Time(std::chrono::hours(1));
    EXPECT_LT(simulation.run(10, microseconds(2), microseconds(300)), 0.02);
    EXPECT_EQ(simulation.way.way(), 0);
}

TEST(FasterWay, TakesTheSecondWhereItIsFasterAndGoesBackWhenItIsNot) {
    Simulation simulation;
    Simulation::now = FasterWay::Time(std::chrono::hours(1));
    EXPECT_GT(simulation.run(10, microseconds(300), microseconds(100)), 0.95);
    EXPECT_EQ(simulation.way.way(), 1);
    simulation.run(12, microseconds(300), microseconds(900)); // two of the longest pauses
    EXPECT_EQ(simulation.way.way(), 0);
}

TEST(FasterWay, DoesNotChangeForATrifle) {
    Simulation simulation;
    Simulation::now = FasterWay::Time(std::chrono::hours(1));
    simulation.run(10, microseconds(300), microseconds(290));
    EXPECT_EQ(simulation.way.way(), 0);
}

/// Returns the share of the batches that went way 1. As the host goes on, its batches take longer,
/// whichever way they go.
double share_by_way1(int batches, microseconds way0, microseconds way1) {
    static FasterByTurns::Time now;
    now = FasterByTurns::Time(std::chrono::hours(1));
    FasterByTurns ways;
    double by_way1 = 0;
    for (int i = 0; i < batches; ++i) {
        const FasterByTurns::Batch batch(ways, /* work= */ 100, [] { return now; });
        now += (batch.way() == 0 ? way0 : way1) * (1 + i / 2000);
        by_way1 += batch.way();
    }
    return by_way1 / batches;
}

TEST(FasterByTurns, TakesTheFasterWay) {
    EXPECT_GT(share_by_way1(20'000, microseconds(300), microseconds(100)), 0.95);
    EXPECT_LT(share_by_way1(20'000, microseconds(100), microseconds(300)), 0.02);
    EXPECT_LT(share_by_way1(20'000, microseconds(300), microseconds(290)), 0.02) << "a trifle";
    EXPECT_EQ(share_by_way1(60, microseconds(300), microseconds(100)), 0) << "few batches";
}

TEST(FasterWay, ManyThreadsMayAskAtOnce) {
    FasterWay way;
    std::vector<std::thread> threads;
    const auto latest = FasterWay::Clock::now() + std::chrono::seconds(60);
    for (int t = 0; t < 16; ++t)
        threads.emplace_back([&] {
            while (way.way() == 0 && FasterWay::Clock::now() < latest) {
                const FasterWay::Use use = way.begin();
                std::this_thread::sleep_for(microseconds(use.way == 0 ? 400 : 50));
                way.end(use, true);
            }
        });
    for (std::thread& thread : threads)
        thread.join();
    EXPECT_EQ(way.way(), 1);
}

} // namespace
} // namespace ovc
