// SPDX-License-Identifier: Apache-2.0
// Tests the colors of leaves and files that cannot be read.
#include "host/output/leaf_patches.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

float apart(const PatchColor& a, const PatchColor& b) {
    return std::max(
        {std::abs(a.red - b.red), std::abs(a.green - b.green), std::abs(a.blue - b.blue)});
}

TEST(LeafPatches, LeavesThatFollowEachOtherLookDifferent) {
    for (uint32_t leaf = 0; leaf < 1000; ++leaf)
        for (uint32_t next = leaf + 1; next < leaf + 5; ++next)
            EXPECT_GT(apart(patch_color(leaf), patch_color(next)), 0.2f) << leaf << ", " << next;
}

TEST(LeafPatches, NameAFileThatIsNoPicture) {
    const Result<std::string> png = leaf_patches(OVC_SOURCE_DIR "/README.md");
    ASSERT_FALSE(png);
    EXPECT_THAT(png.error().message, testing::HasSubstr("README.md"));
}

} // namespace
} // namespace ovc
