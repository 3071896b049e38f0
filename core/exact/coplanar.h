// SPDX-License-Identifier: Apache-2.0
// Whether triangles lie in one plane. A ray that hits both then meets them in one point, and no
// arithmetic on where it does so could tell them apart.
#pragma once

#include "core/soup.h"

namespace ovc {

/// True: the six corners, which are finite, lie exactly in one plane. False: they do not, or it
/// would take longer to say than to compare hits exactly. Corners of floats are decided where the
/// largest extent is up to 2^34 times the smallest coordinate, and all that share an axis plane.
bool surely_coplanar(const Triangle& a, const Triangle& b);

} // namespace ovc
