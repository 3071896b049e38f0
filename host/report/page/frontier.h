// SPDX-License-Identifier: Apache-2.0
// The frontier has the choices that no other choice dominates.
#pragma once

#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// The costs of a choice; less is better in each.
struct Choice {
    double seconds = 0;
    std::vector<double> errors; // every choice has the same number of them
};

/// Times closer than this share count as the same, because calls in one run differ by as much.
inline constexpr double kSameTime = 0.05;

/// Returns the fastest choice that dominates choice i: none of its errors is larger, and it is
/// faster by more than kSameTime, or it has a smaller error and is not slower. Returns nothing
/// where choice i is on the frontier. i is an index of choices (asserted).
std::optional<size_t> dominating(std::span<const Choice> choices, size_t i);

} // namespace ovc
