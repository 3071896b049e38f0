// SPDX-License-Identifier: Apache-2.0
// Reads the values that may stand to the right of #declare's =, or as an argument of a macro.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads a value: a number, a text, an object, a texture, an array or any other kind of Value.
Value parse_value(Reader& reader);

} // namespace ovc::pov
