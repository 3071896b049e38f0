// SPDX-License-Identifier: Apache-2.0
// Suggests what a mistyped word or file name was probably meant to be.
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

/// Returns the candidate that is fewest edits away from `word`, the first of several; empty where
/// none is near enough to be meant.
std::string_view nearest(std::string_view word, std::span<const std::string_view> candidates);

/// Returns "; did you mean 'render'?", or nothing.
std::string did_you_mean(std::string_view word, std::span<const std::string_view> candidates);

/// Returns the same for a missing file, from its folder: "; did you mean 'dragon.ply'?". Case does
/// not matter. Of a folder of very many files only some are looked at.
std::string did_you_mean_file(const std::filesystem::path& missing);

} // namespace ovc
