// SPDX-License-Identifier: Apache-2.0
// Tests whether two triangles lie in one plane. A ray that hits both then meets them in one point,
// and no arithmetic on t could tell them apart.
#pragma once

#include "core/soup.h"

namespace ovc {

/// Returns true only where the six corners, which are finite, lie exactly in one plane. False: they
/// do not, or it would take longer to say than to compare hits exactly. Corners of floats are
/// decided where the largest extent is up to 2^34 times the smallest coordinate, and triangles that
/// share an axis plane always are.
bool surely_coplanar(const Triangle& a, const Triangle& b);

} // namespace ovc
