// SPDX-License-Identifier: Apache-2.0
// Every two switches meet in a variant, and this machine's driver compiles all variants.
#include "gpu/variants/kernel_variants.h"

#include "gpu/gl/test_gl.h"
#include "gpu/gl/workarounds.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace ovc {
namespace {

TEST(KernelVariants, SwitchesMeetInAllWays) {
    const std::vector<ShaderConfig> variants = kernel_variants();
    const auto there = [&](auto fits) { return std::ranges::any_of(variants, fits); };
    for (const bool a : {false, true})
        for (const bool b : {false, true}) {
            EXPECT_TRUE(there([&](const ShaderConfig& c) {
                return c.compute == a && (c.reads == TexelReads::Images) == b;
            }));
            EXPECT_TRUE(there([&](const ShaderConfig& c) {
                return (c.reads == TexelReads::StorageBuffers) == a && c.portals == b;
            }));
            EXPECT_TRUE(
                there([&](const ShaderConfig& c) { return c.any_hit == a && c.certify == b; }));
            EXPECT_TRUE(there([&](const ShaderConfig& c) {
                return (c.pool_buffers > 1) == a && c.branches == b;
            }));
            EXPECT_EQ(
                there([&](const ShaderConfig& c) { return (c.packet > 1) == a && c.portals == b; }),
                !(a && b));
            EXPECT_EQ(there([&](const ShaderConfig& c) { return c.refill == a && c.compute == b; }),
                      !(a && !b));
        }
    EXPECT_LT(variants.size(), 40u) << "all are compiled by the tests";
}

class KernelVariantsGl : public test::OnGl {};

TEST_F(KernelVariantsGl, AreAllCompiled) {
    const bool ballots = gl->info().has_ballots;
    gl->run([&](GlState&) {
        const auto* renderer = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        const bool narrow = needs(Workaround::NarrowFragments) &&
                            std::string_view(renderer).find("512 bits") != std::string_view::npos;
        size_t compiled = 0;
        for (const ShaderConfig& config : kernel_variants()) {
            if ((config.claims && !ballots) || (!config.compute && narrow))
                continue;
            const Result<gl::Program> program = link_program(stages_of(config), config.defines());
            EXPECT_TRUE(program) << config.defines() << program.error().message;
            ++compiled;
        }
        EXPECT_GE(compiled, 5u);
        RecordProperty("compiled", int(compiled));
    });
}

} // namespace
} // namespace ovc
