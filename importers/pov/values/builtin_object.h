// SPDX-License-Identifier: Apache-2.0
// Functions that ask about an object: min_extent, max_extent, trace. Each from the ( on.
#pragma once

#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// (OBJECT): the corner of its box that `token` names.
Number parse_extent(Reader& reader, const Token& token);

/// (OBJECT, FROM, DIRECTION [, NORMAL]): where a ray first meets it; the normal of length 1 goes
/// into the variable NORMAL. Both are 0 where nothing is met.
Number parse_trace(Reader& reader, const Token& token);

} // namespace ovc::pov
