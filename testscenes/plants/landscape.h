// SPDX-License-Identifier: Apache-2.0
// The land of the plants scene: a valley with a river that widens into a lake, between hills. Units
// are metres and y is up. The viewer stands near the origin and looks towards -z, and the water
// lies at y = 0.
#pragma once

#include "core/vec.h"

namespace ovc::plants {

/// The viewer stands here, x and z. Vegetation is densest and most detailed around this point.
inline constexpr dvec2 kViewpoint{0.0, 4.0}; // x, z

/// The land reaches this far from the origin along x and z.
inline constexpr double kReach = 1400;

/// Returns about how far (x, z) lies from the water's edge. It is negative in the water.
double shore_distance(dvec2 at);

/// Returns the height of the ground, or of the river bed below water.
double ground_height(dvec2 at);

/// Returns the steepest rise of the ground over a metre.
double ground_slope(dvec2 at);

} // namespace ovc::plants
