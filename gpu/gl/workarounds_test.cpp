// SPDX-License-Identifier: Apache-2.0
// The table of workarounds: which drivers match, and how entries are switched off.
#include "gpu/gl/workarounds.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

namespace ovc {
namespace {

TEST(Workarounds, StandInTheOrderOfTheirNumbers) {
    for (size_t i = 0; i < kWorkarounds.size(); ++i)
        EXPECT_EQ(size_t(kWorkarounds[i].which), i) << kWorkarounds[i].name;
}

TEST(Workarounds, StandInTheGuide) {
    std::ifstream file(OVC_SOURCE_DIR "/docs/guide/gpu.md");
    const std::string guide((std::istreambuf_iterator<char>(file)), {});
    for (const WorkaroundEntry& entry : kWorkarounds) {
        std::string row = "| `";
        row.append(entry.name).append("` |");
        EXPECT_NE(guide.find(row), guide.npos) << entry.name;
    }
}

TEST(Workarounds, AreForTheDriversThatTheyName) {
    const char* const llvmpipe = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_TRUE(has_defect(Workaround::CountedRounds, llvmpipe, "4.5 (Core Profile) Mesa 22.3.6"));
    EXPECT_FALSE(has_defect(Workaround::CountedRounds, "NVIDIA H200", "4.6.0 NVIDIA 550"));
    EXPECT_TRUE(has_defect(Workaround::CountedRounds, "virgl (LLVMPIPE (LLVM 15))", "4.3 Mesa"));
    EXPECT_TRUE(has_defect(Workaround::PassedOver, "zink (llvmpipe)", "4.6 Mesa 22.3.6"));
    EXPECT_FALSE(has_defect(Workaround::PassedOver, "zink (NVIDIA)", "4.6 Mesa 25.0.1"));
    EXPECT_TRUE(has_defect(Workaround::RendererInSources, "NVIDIA H200", "4.6.0 NVIDIA 550"));
}

TEST(Workarounds, AreSwitchedOffByName) {
    setenv("OVERCAST_NO_WORKAROUNDS", "counted-rounds,finished-pass", 1);
    EXPECT_TRUE(is_switched_off(Workaround::CountedRounds));
    EXPECT_TRUE(is_switched_off(Workaround::FinishedPass));
    EXPECT_FALSE(is_switched_off(Workaround::NarrowFragments));
    unsetenv("OVERCAST_NO_WORKAROUNDS");
    EXPECT_FALSE(is_switched_off(Workaround::CountedRounds));
}

} // namespace
} // namespace ovc
