// SPDX-License-Identifier: Apache-2.0
// Rays and hits as lines of text, for `overcast trace`.
#pragma once

#include "core/ray.h"
#include "core/result.h"

#include <string>
#include <string_view>

namespace ovc {

/// "ox oy oz dx dy dz" or with " tmin tmax", separated by blanks or tabs; 0 and infinity are the
/// default interval; what follows a # is a comment. inf and nan are numbers here: such a ray is
/// answered by the backend. A number too small for a double is 0, one too large an Error. The Error
/// does not name the line.
Result<Ray> parse_ray(std::string_view line);

/// True for a line that holds no ray and is passed over: blank, or a comment that begins with #.
bool is_blank_line(std::string_view line);

/// Appends "t u v mesh prim" in the shortest decimals that read back as the same doubles, or
/// "miss", and a line end.
void append_hit(std::string& text, const Hit& hit);

} // namespace ovc
