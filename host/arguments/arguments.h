// SPDX-License-Identifier: Apache-2.0
// Arguments: what every subcommand does with its words, and errors that say what was meant. CLI11
// does the parsing.
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

/// Parses a subcommand's arguments; --help prints its help. Error: one sentence, with the nearest
/// option there is.
Result<Parsed> parse_arguments(CLI::App& app, std::vector<std::string> arguments);

/// A whole number from least to most. option: named in the error.
Result<uint64_t> parse_count(std::string_view option, std::string_view text, uint64_t least,
                             uint64_t most);

/// A number from least to most, likewise.
Result<double> parse_real(std::string_view option, std::string_view text, double least,
                          double most);

/// The place of `text` among `names`; 0 where it is empty.
Result<size_t> parse_choice(std::string_view option, std::string_view text,
                            std::span<const std::string_view> names);

/// "auto|fragment|compute": a type name that the help shows and completion offers.
std::string choice_names(std::span<const std::string_view> names);

/// "640x480"; each side from 1 to 65535.
Result<ImageSize> parse_size(std::string_view option, std::string_view text);

/// "ex,ey,ez,tx,ty,tz" or with ",fov" in degrees, 0 < fov < 180; eye and target differ. what: who
/// needs it, in the error.
Result<Camera> parse_camera(std::string_view what, std::string_view text);

/// "x,y,z".
Result<dvec3> parse_position(std::string_view option, std::string_view text);

} // namespace ovc
