// SPDX-License-Identifier: Apache-2.0
// The tilings of the plane of x and z by polygons that POV-Ray's pattern `tiling` has by number.
#pragma once

#include "core/vec.h"

#include <cstddef>

namespace ovc {

/// Tilings have the numbers 1 to this. Numbers 25 to 27 of povray, which have no period, are not
/// among them.
inline constexpr size_t kTilings = 24;

/// Returns the value from 0 to 1 of the tiling at a point of which y does not count. Each class of
/// tiles has a range of its own, from its lowest value far inside to its highest along the edges.
/// number: 1 to kTilings.
double tiling(size_t number, const dvec3& at);

} // namespace ovc
