// SPDX-License-Identifier: Apache-2.0
// Shader sources: includes are found, defines come first, logs name the file.
#include "gpu/gl/kernel.h"

#include "gpu/bvh/bvh.h"
#include "shaders/sources.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ovc {
namespace {

using testing::AnyOf;
using testing::HasSubstr;

TEST(ShaderSource, IncludesAreReplacedAndDefinesFollowTheVersion) {
    std::vector<std::string> files;
    const Result<std::string> source =
        expand_shader("trace.frag.glsl", ShaderConfig{.any_hit = true}.defines(), files);
    ASSERT_TRUE(source);
    EXPECT_THAT(*source, Not(HasSubstr("#include")));
    EXPECT_THAT(*source, HasSubstr("int trace_once("));
    EXPECT_LT(source->find("#version"), source->find("#define OVC_ANY_HIT 1"));
    EXPECT_LT(source->find("#define OVC_ANY_HIT 1"), source->find("#ifndef OVC_ANY_HIT"));
    EXPECT_THAT(files,
                testing::ElementsAre(
                    "trace.frag.glsl", "layout.h", "config.glsl", "page.glsl", "unit.glsl",
                    "box.glsl", "children.glsl", "triangle.glsl", "times.glsl", "float_pairs.glsl",
                    "times_float_pairs.glsl", "times_doubles.glsl", "occluder.glsl", "found.glsl",
                    "pair.glsl", "traverse.glsl", "ray.glsl", "portals.glsl", "local_ray.glsl",
                    "rebase_float_pairs.glsl", "rebase_doubles.glsl", "trace.glsl"));
}

TEST(ShaderSource, AMissingFileIsNamed) {
    std::vector<std::string> files;
    const Result<std::string> source = expand_shader("nothing.glsl", "", files);
    ASSERT_FALSE(source);
    EXPECT_EQ(source.error().message, "no shader source is called 'nothing.glsl'");
}

TEST(ShaderSource, LogsNameTheFile) {
    const std::vector<std::string> files{"trace.frag.glsl", "layout.h", "traverse.glsl"};
    EXPECT_EQ(rewrite_log("2:57(14): error: no\n", files), "traverse.glsl:57(14): error: no\n");
    EXPECT_EQ(rewrite_log("2(57) : error C1: no", files), "traverse.glsl:57 : error C1: no\n");
    EXPECT_EQ(rewrite_log("9:1: unknown file stays", files), "9:1: unknown file stays\n");
    EXPECT_EQ(rewrite_log("plain words", files), "plain words\n");
}

TEST(ShaderSource, ConfigDefinesEverySwitchOfConfigGlsl) {
    const std::string defines = ShaderConfig{}.defines();
    for (const ShaderSource& source : shader_sources()) {
        if (source.name != "config.glsl")
            continue;
        std::string_view text = source.text;
        size_t found = 0;
        for (size_t at = text.find("#ifndef "); at != text.npos;
             at = text.find("#ifndef ", at + 1)) {
            const std::string_view name = text.substr(at + 8, text.find('\n', at) - at - 8);
            const std::string define = "#define " + std::string(name);
            EXPECT_THAT(defines, AnyOf(HasSubstr(define + " "), HasSubstr(define + "(")));
            ++found;
        }
        EXPECT_EQ(found, size_t(std::count(defines.begin(), defines.end(), '\n')));
    }
}

} // namespace
} // namespace ovc
