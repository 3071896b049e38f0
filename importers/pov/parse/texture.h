// SPDX-License-Identifier: Apache-2.0
// Textures: pigments, finishes, interiors. Patterns are drawn together to their average color.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Each from the { on. The result begins as `base`, or as what an identifier in the block names.
Texture parse_texture(Reader& reader);
Pigment parse_pigment(Reader& reader, const Pigment& base);
Surface parse_finish(Reader& reader, const Surface& base);
Interior parse_interior(Reader& reader, const Interior& base);
Material parse_material(Reader& reader);
/// Of colors, pigments or textures.
ColorMap parse_map(Reader& reader);

/// `upper` as it is seen over `lower`.
Texture layered(const Texture& upper, const Texture& lower, const Place& at);

std::shared_ptr<const Note> normal_note(const Token& word);
/// "WORD of a finish is left out"
std::shared_ptr<const Note> left_out(std::string_view of, const Token& word);

/// Passes over what belongs to a word: numbers, texts, a block.
void skip_arguments(Reader& reader);

} // namespace ovc::pov
