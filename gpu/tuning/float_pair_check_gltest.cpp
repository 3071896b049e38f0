// SPDX-License-Identifier: Apache-2.0
// A driver whose arithmetic does not suit pairs of floats is found.
#include "gpu/tuning/float_pair_check.h"

#include "gpu/gl/test_gl.h"

#include <cfenv>
#include <cmath>

namespace ovc {
namespace {

class FloatPairCheckGl : public test::OnGl {};

TEST_F(FloatPairCheckGl, LlvmpipeKeepsThem) {
    if (gl->info().renderer.find("llvmpipe") == std::string::npos)
        GTEST_SKIP() << "every driver may say what it likes";
    gl->run([](GlState&) { EXPECT_TRUE(driver_keeps_float_pairs()); });
}

/// A number that the compiler does not compute with before the program runs, in whatever way the
/// processor rounds then.
using Float = volatile float;

FloatPair two_sum(float a, float b) {
    const Float sum = a + b;
    const Float of_b = sum - a, of_a = sum - of_b;
    const Float rest_a = a - of_a, rest_b = b - of_b;
    const Float rest = rest_a + rest_b;
    return {sum, rest};
}

/// The answers of a processor, rounded as it rounds now. loses_rests: those of a compiler that
/// takes (a + b) - a for b.
std::vector<FloatPairAnswer> answers_of(std::span<const FloatPairQuestion> asked,
                                        bool loses_rests) {
    std::vector<FloatPairAnswer> told;
    for (const auto& [a, b] : asked) {
        const auto as_pair = [&](double value) {
            const volatile double exact = value;
            const Float hi = float(exact);
            const volatile double rest = exact - double(hi);
            const Float lo = float(rest);
            return FloatPair{hi, loses_rests ? 0 : lo};
        };
        FloatPair sum = two_sum(a.hi, b.hi);
        sum.lo = loses_rests ? 0 : sum.lo;
        told.push_back({sum, as_pair(double(a.hi) * double(b.hi)), as_pair(a.value() + b.value()),
                        as_pair(a.value() * b.value())});
    }
    return told;
}

TEST(FloatPairCheck, ADriverThatRoundsOtherwiseOrReordersIsFound) {
    const std::vector<FloatPairQuestion> asked = float_pair_questions();
    EXPECT_TRUE(are_right(asked, answers_of(asked, false)));
    EXPECT_FALSE(are_right(asked, answers_of(asked, true)));
    for (const int rounding : {FE_TOWARDZERO, FE_UPWARD, FE_DOWNWARD}) {
        std::fesetround(rounding);
        const std::vector<FloatPairAnswer> told = answers_of(asked, false);
        std::fesetround(FE_TONEAREST);
        EXPECT_FALSE(are_right(asked, told)) << rounding;
    }
}

} // namespace
} // namespace ovc
