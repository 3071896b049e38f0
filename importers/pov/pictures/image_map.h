// SPDX-License-Identifier: Apache-2.0
// image_map { }: a picture, drawn by its average color.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// From the { on: the pigment's color, and notes that say so. A middle grey where there is no
/// picture.
void parse_image_map(Reader& reader, const Token& word, Pigment& pigment);

} // namespace ovc::pov
