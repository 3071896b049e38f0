// SPDX-License-Identifier: Apache-2.0
// Reads textures, pigments, finishes and interiors.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Each of these reads a block from its { on. The result starts as `base`, or as a declared value
/// that the block names, and the block's parts change it.
Texture parse_texture(Reader& reader);
Pigment parse_pigment(Reader& reader, const Pigment& base);
Normal parse_normal(Reader& reader, const Normal& base);
Surface parse_finish(Reader& reader, const Surface& base);
Interior parse_interior(Reader& reader, const Interior& base);
Material parse_material(Reader& reader);
/// Reads the parts of a pigment, texture or normal up to `end`, which stays.
Pigment parse_pigment_parts(Reader& reader, Pigment pigment, char end);
Texture parse_texture_parts(Reader& reader, Texture texture, char end);
Normal parse_normal_parts(Reader& reader, const Normal& base, char end);
/// Reads the { … } of a slope_map.
std::vector<SlopeStop> parse_slope_map(Reader& reader);

/// Returns `upper`, with its layers, on top of `lower`. Throws ParseError where that is too many.
Texture layered(Reader& reader, const Texture& upper, const Texture& lower);
/// Returns the texture that the map of textures mixes.
Texture mix_of(PatternPtr map);
/// Returns the texture with all its layers, and what it mixes, on texture coordinates.
Texture on_texture_coordinates(Texture texture);
/// Moves the texture with all its layers.
void place(Texture& texture, const dmat4& by);
/// Moves the interior's media.
void place(Interior& interior, const dmat4& by);

/// Returns the note "WORD of a finish is left out", where `of` is "a finish".
const Note* left_out(Reader& reader, std::string_view of, const Token& word);
/// Takes one of the words, which Overcast leaves out, with its arguments, and adds that note.
bool take_left_out(Reader& reader, std::initializer_list<std::string_view> words,
                   std::string_view of, Notes& notes);

/// Skips the arguments of a word that Overcast does not use: numbers, texts, and at most one block.
void skip_arguments(Reader& reader);
/// Takes one of the words, which change nothing here, with its arguments. Returns false where
/// another word is next.
bool take_skipped(Reader& reader, std::initializer_list<std::string_view> words);

} // namespace ovc::pov
