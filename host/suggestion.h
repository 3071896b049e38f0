// SPDX-License-Identifier: Apache-2.0
// Near misses: what a mistyped word was probably meant to be.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace ovc {

/// The candidate that is fewest edits away from `word`, if it is near enough to be meant; else
/// empty.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'render'?", or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

} // namespace ovc
