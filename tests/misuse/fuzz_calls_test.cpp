// SPDX-License-Identifier: Apache-2.0
// Runs the fuzzer's function over random sequences of calls, which are the same on every run, and
// over those that it once failed on. OVC_FUZZ_SECONDS: for as long as that, instead of 300 times.
#include "tests/fuzz/calls.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <vector>

namespace ovc {
namespace {

TEST(FuzzCalls, RandomSequencesOfCallsGetRightAnswersOrErrors) {
    const char* const told = std::getenv("OVC_FUZZ_SECONDS");
    const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(told ? atoi(told) : 0);
    for (uint32_t seed = 0; seed < 300 || std::chrono::steady_clock::now() < end; ++seed) {
        SCOPED_TRACE(seed);
        std::mt19937 random(seed);
        std::vector<uint8_t> bytes(200 + random() % 4000);
        for (uint8_t& byte : bytes)
            byte = uint8_t(random() >> 8);
        if (!fuzz_calls(bytes.data(), bytes.size()))
            GTEST_SKIP() << "no device";
    }
}

TEST(FuzzCalls, SequencesThatFailedOnceDoNotFailAgain) {
    for (const auto& entry :
         std::filesystem::directory_iterator(OVC_SOURCE_DIR "/tests/fuzz/calls")) {
        SCOPED_TRACE(entry.path());
        std::ifstream file(entry.path(), std::ios::binary);
        const std::string bytes(std::istreambuf_iterator<char>(file), {});
        ASSERT_FALSE(bytes.empty());
        if (!fuzz_calls(reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()))
            GTEST_SKIP() << "no device";
    }
}

} // namespace
} // namespace ovc
