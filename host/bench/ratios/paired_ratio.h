// SPDX-License-Identifier: Apache-2.0
// PairedRatio: the ratio of two times that were measured by turns, and how sure it is.
#pragma once

#include <optional>
#include <span>

namespace ovc {

struct PairedRatio {
    double median = 0;
    /// The median of many more turns lies in [low, high] with a probability of 90 % at least: the
    /// interval between two order statistics that holds it, which asks for no distribution (David
    /// and Nagaraja 2003, "Order Statistics", section 7.1). With four turns or fewer no interval is
    /// as sure as that, and it is that of all of them.
    double low = 0, high = 0;
};

/// Returns over[i] / under[i], of turns i. Nothing where there are none of one of both, or not as
/// many, or a time is not above 0.
std::optional<PairedRatio> paired_ratio(std::span<const double> over,
                                        std::span<const double> under);

} // namespace ovc
