// SPDX-License-Identifier: Apache-2.0
// Reads image_map { }, a picture of which the average color and the holes are kept.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads an image_map from its { on. Sets the pigment's color to the picture's average, or to a
/// middle grey where the picture cannot be read, its notes to say so, and its holes.
void parse_image_map(Reader& reader, const Token& word, Pigment& pigment);

} // namespace ovc::pov
