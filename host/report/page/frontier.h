// SPDX-License-Identifier: Apache-2.0
// Frontier: the choices that no other makes pointless.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// What a choice costs: less is better, in each.
struct Choice {
    double seconds = 0;
    std::vector<double> errors; // as many in each choice
};

/// Times closer than this are the same: calls in one run differ by as much.
inline constexpr double kSameTime = 0.05;

/// The choice that dominates choice i: no error of it is larger, and it is faster by more than
/// kSameTime, or has a smaller error and is not slower; of several, the fastest. Nothing: choice i
/// is on the frontier.
std::optional<size_t> dominating(std::span<const Choice> choices, size_t i);

} // namespace ovc
