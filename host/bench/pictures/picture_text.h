// SPDX-License-Identifier: Apache-2.0
// Writes what pictures cost and how wrong they are, as tables and as JSON (docs/benchmarks.md).
#pragma once

#include "host/bench/pictures/picture_race.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>

namespace ovc {

using Json = nlohmann::ordered_json;

/// Returns a line for each choice that ran, with a line end.
std::string picture_table(const PictureRace& race);
/// Returns a sentence that names the programs, with line ends, or nothing where there are none.
std::string not_installed_text(std::span<const std::string> programs);

/// Returns an object; numbers are null where the choice did not run.
Json picture_json(const PictureCost& cost);
/// Returns the document with a line end.
std::string json_text(const Json& document);

} // namespace ovc
