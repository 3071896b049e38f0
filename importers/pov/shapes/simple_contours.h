// SPDX-License-Identifier: Apache-2.0
// Contours that cross each other or themselves, as contours that do not.
#pragma once

#include "importers/pov/shapes/contour.h"

namespace ovc::pov {

/// Returns contours inside an odd number of which the same points lie as of these, and which may
/// have points in common, but do not cross. Where these do not cross, they are returned as they
/// are. Time grows with the square of the number of points.
std::vector<Contour> simple_contours(std::vector<Contour> contours);

} // namespace ovc::pov
