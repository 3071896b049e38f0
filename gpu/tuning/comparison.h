// SPDX-License-Identifier: Apache-2.0
// Compares two variants by trials in turn, so that whatever else the machine does meets both.
#pragma once

#include "core/function_ref.h"
#include "gpu/tuning/kernel_variant.h"

#include <cstddef>
#include <optional>

namespace ovc {

/// Traces the same rays with a variant, and returns the seconds that the kernel took. Nothing: the
/// device refuses the variant, or its answers contradict those of another.
using TimeVariant = FunctionRef<std::optional<double>(const KernelVariant&)>;

struct VariantComparison {
    double ratio = 1;        // the candidate's time to the other's: the median of all rounds
    double base_seconds = 0; // min of all rounds
    /// Beyond doubt: in all of a few rounds, in three of four where there are many, and by what is
    /// worthwhile in most.
    bool is_faster = false;
};

struct ComparisonLimits {
    size_t rounds = 3; // > 0
    /// A variant that gains less than this is not worth the doubt, which is less after more rounds.
    double worthwhile = 0.03;
};

/// Times both in each round, after a first trial of each that is not counted, in which drivers
/// finish what they compile. Nothing: the candidate cannot be used.
std::optional<VariantComparison> compare(const KernelVariant& base, const KernelVariant& candidate,
                                         const ComparisonLimits& limits, TimeVariant time);

} // namespace ovc
