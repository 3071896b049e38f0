// SPDX-License-Identifier: Apache-2.0
// Asks a driver whether its kernels compute with pairs of floats as shaders/float_pairs.glsl must:
// floats are rounded to nearest, and nothing is reordered.
#pragma once

#include <span>
#include <vector>

namespace ovc {

/// A number as the sum of a float and of the rest that is left of it.
struct FloatPair {
    float hi, lo;

    double value() const { return double(hi) + double(lo); }
};

/// A question to a driver, and its answer (shaders/float_pair_check.comp.glsl).
struct FloatPairQuestion {
    FloatPair a, b;
};
struct FloatPairAnswer {
    FloatPair two_sum, two_product; // of the upper floats
    FloatPair sum, product;
};

/// Returns some hundred questions, many of them sums that cancel.
std::vector<FloatPairQuestion> float_pair_questions();
/// Whether all answers, one for each question, are what arithmetic on pairs relies on.
bool are_right(std::span<const FloatPairQuestion> asked, std::span<const FloatPairAnswer> told);

/// Asks the driver of the current context. It takes 12 KiB of the device for a moment, which belong
/// to no scene's budget.
bool driver_keeps_float_pairs();

} // namespace ovc
