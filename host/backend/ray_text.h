// SPDX-License-Identifier: Apache-2.0
// Rays and hits as lines of text, for `overcast trace`.
#pragma once

#include "core/ray.h"
#include "core/result.h"

#include <string>
#include <string_view>

namespace ovc {

/// Parses "ox oy oz dx dy dz", or with " tmin tmax", separated by blanks or tabs. The default
/// interval is 0 to infinity; a # begins a comment. inf and nan are numbers here: the backend
/// answers such a ray. A number too small for a double is 0, one too large an Error. The Error does
/// not name the line.
Result<Ray> parse_ray(std::string_view line);

/// Returns true for a line to pass over: it is blank, or a comment that begins with #.
bool is_blank_line(std::string_view line);

/// Appends "t u v mesh prim" in the shortest decimals that read back as the same doubles, or
/// "miss", and a line end.
void append_hit(std::string& text, const Hit& hit);

} // namespace ovc
