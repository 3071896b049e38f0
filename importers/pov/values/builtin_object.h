// SPDX-License-Identifier: Apache-2.0
// Reads the functions that ask about an object, min_extent, max_extent, trace and inside, from
// their ( on.
#pragma once

#include "core/region/region.h"
#include "importers/pov/values/expression.h"

namespace ovc::pov {

/// Reads (OBJECT). Returns the corner of its box that `token`, min_extent or max_extent, names.
Number parse_extent(Reader& reader, const Token& token);

/// Reads (OBJECT, FROM, DIRECTION [, NORMAL]). Returns the point where the ray first meets the
/// object, and puts the normal of length 1 there into the variable NORMAL. Both are 0 where the ray
/// misses.
Number parse_trace(Reader& reader, const Token& token);

/// Reads (OBJECT, POINT). Returns 1 for a point inside of the object, else 0.
Number parse_inside(Reader& reader, const Token& token);

/// Returns what the object holds within it, valid until the next call.
const Region& region_of(Reader& reader, const ObjectPtr& object);

} // namespace ovc::pov
