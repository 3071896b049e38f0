// SPDX-License-Identifier: Apache-2.0
// BuildProgress: tests what it reports, how often, and that it stops every thread.
#include "core/build_progress.h"

#include "core/system/parallel.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace ovc {
namespace {

TEST(BuildProgress, GoesFromStageToStageAndNeverBack) {
    std::vector<std::pair<double, std::string>> told;
    BuildProgress progress([&](double done, const char* stage) {
        told.emplace_back(done, stage);
        return true;
    });
    progress.begin("first", 0.25, 10);
    progress.add(10);
    progress.begin("second", 0.5, 10);
    progress.begin("second", 0.5, 10); // once more, as when a build begins anew
    progress.begin("third", 0.5, 10);
    progress.finish();
    ASSERT_EQ(told.size(), 5u) << "nothing is told twice within a moment";
    EXPECT_EQ(told[0], std::pair(0.0, std::string("first")));
    EXPECT_EQ(told[1], std::pair(0.25, std::string("second")));
    EXPECT_EQ(told[2].first, 0.75);
    EXPECT_EQ(told[3].first, 1.0) << "1.25 of the whole is no more than all";
    EXPECT_EQ(told[4], std::pair(1.0, std::string("done")));
}

TEST(BuildProgress, StopsTheThreadThatIsToldAndAllOthers) {
    BuildProgress progress([&](double done, const char*) { return done < 0.5; });
    progress.begin("work", 1, 1 << 26);
    std::atomic<uint64_t> rounds{0};
    const auto work = [&] {
        parallel_for(64, 1, [&](size_t, size_t) {
            LoopProgress loop(&progress);
            for (int i = 0; i < 1 << 20; ++i, loop.step())
                rounds.fetch_add(1, std::memory_order_relaxed);
            loop.finish();
        });
    };
    EXPECT_THROW(work(), Cancelled);
    EXPECT_GE(rounds, 1u << 25);
    EXPECT_LT(rounds, 1u << 26);
    EXPECT_THROW(progress.add(0), Cancelled) << "and whoever comes later";
}

TEST(BuildProgress, NobodyWaitingIsFine) {
    begin(nullptr, "work", 1, 10);
    LoopProgress loop(nullptr);
    for (int i = 0; i < 10000; ++i)
        loop.step();
    loop.finish();
}

} // namespace
} // namespace ovc
