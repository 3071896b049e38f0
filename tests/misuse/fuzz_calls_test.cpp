// SPDX-License-Identifier: Apache-2.0
// Runs the fuzzer's function over random sequences of calls, which are the same on every run.
#include "tests/fuzz/calls.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace ovc {
namespace {

TEST(FuzzCalls, RandomSequencesOfCallsGetRightAnswersOrErrors) {
    for (uint32_t seed = 0; seed < 300; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        std::vector<uint8_t> bytes(200 + random() % 4000);
        for (uint8_t& byte : bytes)
            byte = uint8_t(random() >> 8);
        if (!fuzz_calls(bytes.data(), bytes.size()))
            GTEST_SKIP() << "no device";
    }
}

} // namespace
} // namespace ovc
