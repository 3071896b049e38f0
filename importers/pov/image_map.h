// SPDX-License-Identifier: Apache-2.0
// image_map { }: a picture, drawn by its average color.
#pragma once

#include "importers/pov/expression.h"

namespace ovc::pov {

/// From the { on. Nothing, and a warning that names it: there is no such picture.
std::optional<Color> parse_image_map(Reader& reader, const Token& word);

} // namespace ovc::pov
