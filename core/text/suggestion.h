// SPDX-License-Identifier: Apache-2.0
// Near misses: what a mistyped word or file name was probably meant to be.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

/// The candidate that is fewest edits away from `word`, if it is near enough to be meant; else
/// empty. Of several the first.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// "; did you mean 'render'?", or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// The same of a file that is not there, among those of its folder: "; did you mean 'dragon.ply'?".
/// Capitals count for nothing. Of a folder of very many files only some are looked at.
std::string did_you_mean_file(const std::filesystem::path& missing);

} // namespace ovc
