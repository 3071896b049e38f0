// SPDX-License-Identifier: Apache-2.0
// Reads the blocks that name a picture: image_map, image_pattern, bump_map, and the picture of a
// material_map.
#pragma once

#include "importers/pov/values/expression.h"

#include <functional>

namespace ovc::pov {

/// Reads what the word gamma says: light is a code ^ gamma, or sRGB's (kSrgbGamma).
double parse_gamma(Reader& reader);

/// Reads an image_map from its { on. Sets the pigment's color to the picture's average, or to a
/// middle grey where the picture cannot be read, its notes to say so, and its holes.
void parse_image_map(Reader& reader, const Token& word, Pigment& pigment);

/// A picture whose numbers matter and not its colors. Its values go from 0 to 1.
struct ValueMap {
    std::optional<ImageMap> image;   // none: the picture cannot be read
    const Note* why_not = nullptr;   // says so
    std::optional<double> bump_size; // where the block has one
};

/// Reads an image_pattern or a bump_map from its { on. `word` names it.
ValueMap parse_value_map(Reader& reader, const Token& word);

/// Returns a picture whose values are i / 255 for texture i of `count`, which is 1 to 256: the
/// index into the picture's table of colors, or without a table its red, modulo `count`, but the
/// last texture for `count` itself.
using MaterialValues = std::function<ValueMap(Reader& reader, size_t count)>;

/// Reads the picture of a material_map, from its { to the first texture.
MaterialValues parse_material_picture(Reader& reader, const Token& word);

} // namespace ovc::pov
