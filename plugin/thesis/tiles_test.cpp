// SPDX-License-Identifier: Apache-2.0
// Tiles hold all texels, no texture is larger than allowed, and a scene past the limit is refused
// with its numbers.
#include "plugin/thesis/tiles.h"

#include "plugin/thesis/runner.h"

#include <gtest/gtest.h>

namespace ovc::thesis {
namespace {

TEST(Tiles, HoldEveryTexel) {
    for (const uint64_t texels : {1, 2, 3, 5, 4095, 4097, 70000, 16777216, 16777217, 100000000})
        for (const uint32_t textures : {1u, 2u, 4u}) {
            const TilePlan plan = plan_tiles(texels, textures);
            uint64_t held = 0;
            for (uint32_t tile = 0; tile < plan.count(); ++tile) {
                EXPECT_LE(plan.height(tile), 4096u);
                EXPECT_LE(plan.tile_bytes(tile), kTextureBytes);
                held += uint64_t(plan.width()) * plan.height(tile);
            }
            EXPECT_LE(plan.width(), 4096u);
            EXPECT_GE(held, texels);
            EXPECT_LT(held, texels + plan.width());
            EXPECT_GE(plan.count(), std::min<uint64_t>(textures, texels));
        }
}

TEST(Tiles, OneTextureHoldsWhatTheThesisHadInOne) {
    EXPECT_EQ(plan_tiles(4096 * 4096, 1).count(), 1u);
    EXPECT_EQ(plan_tiles(4096 * 4096 + 1, 1).count(), 2u);
    EXPECT_EQ(kTextureBytes, 256u << 20);
}

TEST(Tiles, ASceneTooLargeIsRefusedWithItsNumbers) {
    RunnerOptions options;
    options.budget_bytes = uint64_t(1) << 40;
    EXPECT_TRUE(plan_memory(options, 4096 * 4096));
    const auto refused = plan_memory(options, 4096 * 4096 + 1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().message,
              "single-texture: the scene takes 268435472 bytes; a texture of 4096 x 4096 texels "
              "holds 268435456, and it uses 1");
    options.structure = OVC_STRUCTURE_MULTI_TEXTURE;
    EXPECT_TRUE(plan_memory(options, 8 * 4096 * 4096));
    EXPECT_FALSE(plan_memory(options, 8 * 4096 * 4096 + 1));
}

} // namespace
} // namespace ovc::thesis
