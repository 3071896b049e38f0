// SPDX-License-Identifier: Apache-2.0
// Reads textures, pigments, finishes and interiors. A pattern becomes its average color.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Each of these reads a block from its { on. The result starts as `base`, or as a declared value
/// that the block names, and the block's parts change it.
Texture parse_texture(Reader& reader);
Pigment parse_pigment(Reader& reader, const Pigment& base);
Surface parse_finish(Reader& reader, const Surface& base);
Interior parse_interior(Reader& reader, const Interior& base);
Material parse_material(Reader& reader);
/// Reads a map of colors, pigments or textures from its { on.
ColorMap parse_map(Reader& reader);

/// Returns one texture that looks like `upper` on top of `lower`.
Texture layered(Reader& reader, const Texture& upper, const Texture& lower, const Place& at);

const Note* normal_note(Reader& reader, const Token& word);
/// Returns the note "WORD of a finish is left out", where `of` is "a finish".
const Note* left_out(Reader& reader, std::string_view of, const Token& word);

/// Skips the arguments of a word that Overcast does not use: numbers, texts, and at most one block.
void skip_arguments(Reader& reader);

} // namespace ovc::pov
