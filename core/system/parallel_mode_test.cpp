// SPDX-License-Identifier: Apache-2.0
// Loops run in the floating-point mode of the thread that starts them, whatever mode the process
// was in when oneTBB, which hosts use too, began.
#include "core/system/parallel.h"

#include <gtest/gtest.h>

#include <oneapi/tbb/parallel_for.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>
#include <vector>
#include <xmmintrin.h>

namespace ovc {
namespace {

constexpr uint32_t kDefault = 0x1f80, kOfTheHost = 0x1f80 | 0x8040 | 0x4000; // FTZ, DAZ, up
constexpr uint32_t kFlags = 0x3f;

class ParallelMode : public testing::Test {
protected:
    /// Starts oneTBB's threads by a loop in the host's mode, then takes the plugin's mode.
    void SetUp() override {
        _mm_setcsr(kOfTheHost);
        oneapi::tbb::parallel_for(0, 64, [](int) { look(); });
        _mm_setcsr(kDefault);
        strange = 0;
    }

    static void look() {
        strange += (_mm_getcsr() & ~kFlags) != kDefault;
        std::this_thread::sleep_for(std::chrono::microseconds(200)); // so that others take a part
    }

    static inline std::atomic<int> strange{0};
};

TEST_F(ParallelMode, ForRunsInTheModeOfWhoStartsIt) {
    parallel_for(256, 1, [](size_t, size_t) { look(); });
    EXPECT_EQ(strange, 0);
}

TEST_F(ParallelMode, ReduceRunsInTheModeOfWhoStartsIt) {
    const int sum = parallel_reduce(
        size_t(64) * 4096, 0,
        [](size_t, size_t, int value) {
            look();
            return value + 1;
        },
        [](int a, int b) { return a + b; });
    EXPECT_GT(sum, 0);
    EXPECT_EQ(strange, 0);
}

TEST_F(ParallelMode, InvokeRunsInTheModeOfWhoStartsIt) {
    for (int i = 0; i < 50; ++i) {
        parallel_invoke([] { look(); }, [] { look(); });
        in_forks([](const Fork& fork) { fork([] { look(); }, [] { look(); }); });
    }
    EXPECT_EQ(strange, 0);
}

/// A number whose comparison checks the mode.
struct Looking {
    int value;
    bool operator<(const Looking& other) const;
};

std::atomic<int> strange_comparisons{0};

bool Looking::operator<(const Looking& other) const {
    strange_comparisons += (_mm_getcsr() & ~kFlags) != kDefault;
    return value < other.value;
}

TEST_F(ParallelMode, SortRunsInTheModeOfWhoStartsIt) {
    std::vector<Looking> numbers;
    for (int i = 0; i < 20000; ++i)
        numbers.push_back({i * 7919 % 20000});
    parallel_sort(numbers.begin(), numbers.end());
    EXPECT_TRUE(std::is_sorted(numbers.begin(), numbers.end()));
    EXPECT_EQ(strange_comparisons, 0);
}

} // namespace
} // namespace ovc
