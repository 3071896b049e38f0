// SPDX-License-Identifier: Apache-2.0
// Reads what a pattern chooses from: the entries of a map or of a list.
#pragma once

#include "importers/pov/values/expression.h"

#include <vector>

namespace ovc::pov {

/// The use of a pattern.
enum class MapOf { Pigments, Textures, Normals };

/// Reads a map of colors, pigments, textures or normals from its { on.
ColorMap parse_map(Reader& reader, MapOf of);

/// Reads the entries of a list, as many as there are; the number of each is its `at`.
std::vector<MapStop> parse_entries(Reader& reader, MapOf of);

/// Returns the colors that povray gives a pattern without a map or list. word: the pattern's name,
/// or null.
std::vector<MapStop> default_stops(const Token* word, Pattern::Kind kind);

/// Sets how many parts the map has and how deep they lie, once it has its stops. Throws ParseError
/// beyond a limit: a texture that mixes one that mixes one with itself has twice as many at each
/// step, and whoever follows patterns into each other needs room on the stack.
void count_parts(Reader& reader, PatternMap& map);

/// Throws ParseError where the texture with its layers is beyond these limits.
void check_parts(Reader& reader, const Texture& texture);

/// Returns the average of the stops over [0, 1], a middle grey where there are none.
Color average_of(const std::vector<MapStop>& stops);

} // namespace ovc::pov
