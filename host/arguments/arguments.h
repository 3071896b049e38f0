// SPDX-License-Identifier: Apache-2.0
// Parsing of a subcommand's arguments and of their values, with errors that suggest what was meant.
// CLI11 does the parsing.
#pragma once

#include "core/result.h"
#include "core/scene.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

enum class Parsed { Run, HelpShown };

/// Parses a subcommand's arguments into the variables of `app`; --help prints its help instead.
/// Error: one sentence, with the nearest option that there is.
Result<Parsed> parse_arguments(CLI::App& app, std::vector<std::string> arguments);

/// Returns `text` as a whole number from least to most. option: its name in the error.
Result<uint64_t> parse_count(std::string_view option, std::string_view text, uint64_t least,
                             uint64_t most);

/// Returns `text` as a number from least to most. NaN is an error. option: its name in the error.
Result<double> parse_real(std::string_view option, std::string_view text, double least,
                          double most);

/// Returns the index of `text` in `names`, which are not empty; 0, the default, for an empty text.
Result<size_t> parse_choice(std::string_view option, std::string_view text,
                            std::span<const std::string_view> names);

/// Returns a type name such as "auto|fragment|compute", which the help shows and completion offers.
std::string choice_names(std::span<const std::string_view> names);

/// Parses a size such as "640x480"; each side is from 1 to 65535.
Result<ImageSize> parse_size(std::string_view option, std::string_view text);

/// Parses "ex,ey,ez,tx,ty,tz", or with ",fov" in degrees, 0 < fov < 180; eye and target differ.
/// what: the name of the option, or of the place in a file, that the error blames.
Result<Camera> parse_camera(std::string_view what, std::string_view text);

/// Parses "x,y,z", each finite and of at most kFarthest in size.
Result<dvec3> parse_position(std::string_view option, std::string_view text);

} // namespace ovc
