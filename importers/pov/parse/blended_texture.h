// SPDX-License-Identifier: Apache-2.0
// Blends textures by formulas of the place: those of a blob's parts and of a triangle's corners.
#pragma once

#include "importers/pov/values/program.h"
#include "importers/pov/values/value.h"

#include <optional>
#include <vector>

namespace ovc::pov {

struct WeightedTexture {
    Texture texture;
    ProgramPtr weight; // of x, y and z; at least 0
};

/// Returns the texture that has at each place a share of each of these in proportion to its weight,
/// or none where the formulas are too long. The places are those of the texture's own space, or
/// with on_corners what the corners of a mesh have in the place of texture coordinates. parts: at
/// least one.
std::optional<Texture> blended(const std::vector<WeightedTexture>& parts, bool on_corners);

/// Returns whether the textures are the same as far as a picture shows.
bool same_look(const Texture& a, const Texture& b);

/// Returns the number of a function of floats, for FormulaStep::Kind::Builtin.
uint32_t builtin(std::string_view name);

} // namespace ovc::pov
