// SPDX-License-Identifier: Apache-2.0
#include "gpu/driver/vector_width.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

using Variables = std::map<std::string, std::string>;

Variables wide(const Variables& set, bool has_avx512 = true, bool fragment_kernels = false) {
    return wide_vectors(
        [&](const char* name) {
            const auto found = set.find(name);
            return found == set.end() ? nullptr : found->second.c_str();
        },
        has_avx512, fragment_kernels);
}

TEST(VectorWidth, IsWideWhereTheCpuIs) {
    EXPECT_EQ(wide({{"HOME", "/home/me"}}),
              (Variables{{"LP_NATIVE_VECTOR_WIDTH", "512"},
                         {"MESA_SHADER_CACHE_DIR", "/home/me/.cache/overcast/mesa-512"}}));
    EXPECT_EQ(wide({{"HOME", "/home/me"}}, /* has_avx512= */ false), Variables{});
}

TEST(VectorWidth, IsNotForFragmentKernels) {
    EXPECT_EQ(wide({{"HOME", "/home/me"}}, /* has_avx512= */ true, /* fragment_kernels= */ true),
              Variables{});
}

TEST(VectorWidth, StaysAsTheUserSays) {
    EXPECT_EQ(wide({{"HOME", "/home/me"}, {"LP_NATIVE_VECTOR_WIDTH", "256"}}), Variables{});
}

/// In a common folder Mesa would find kernels that it compiled for another width.
TEST(VectorWidth, HasAFolderOfItsOwnForWhatMesaKeeps) {
    const auto folder = [](const Variables& set) { return wide(set)["MESA_SHADER_CACHE_DIR"]; };
    EXPECT_EQ(folder({{"HOME", "/home/me"}, {"MESA_SHADER_CACHE_DIR", "/mesa"}}),
              "/mesa/overcast-512");
    EXPECT_EQ(folder({{"HOME", "/home/me"}, {"XDG_CACHE_HOME", "/caches"}}),
              "/caches/overcast/mesa-512");
    EXPECT_EQ(
        wide({{"XDG_CACHE_HOME", "relative"}}),
        (Variables{{"LP_NATIVE_VECTOR_WIDTH", "512"}, {"MESA_SHADER_CACHE_DISABLE", "true"}}));
}

TEST(VectorWidth, IsAdvisedOnWhereNobodyHasChosen) {
    const auto has_advice = [](const char* renderer, const char* width, bool has_avx512) {
        const GetVariable variable = [&](const char*) { return width; };
        return advice_on_vectors(renderer, variable, has_avx512, /* fragment_kernels= */ false)
            .has_value();
    };
    const char* const narrow = "llvmpipe (LLVM 15.0.6, 256 bits)";
    EXPECT_TRUE(has_advice(narrow, nullptr, true));
    EXPECT_FALSE(has_advice(narrow, nullptr, false));
    EXPECT_FALSE(has_advice(narrow, "256", true));
    EXPECT_FALSE(has_advice("llvmpipe (LLVM 15.0.6, 512 bits)", nullptr, true));
    EXPECT_FALSE(has_advice("NVIDIA H200", nullptr, true));
}

/// llvmpipe would crash at 512 bits on the fragment shaders of a host that has said it has some.
TEST(VectorWidth, IsNotAdvisedOnWhereThereAreFragmentShaders) {
    const auto unset = [](const char*) { return nullptr; };
    const std::string advice =
        advice_on_vectors("llvmpipe (LLVM 15.0.6, 256 bits)", unset, /* has_avx512= */ true,
                          /* fragment_kernels= */ true)
            .value_or("");
    EXPECT_THAT(advice, testing::HasSubstr("fragment shaders"));
    EXPECT_THAT(advice, testing::Not(testing::HasSubstr("prepare_process")));
    EXPECT_THAT(advice, testing::Not(testing::HasSubstr("LP_NATIVE_VECTOR_WIDTH")));
}

} // namespace
} // namespace ovc
