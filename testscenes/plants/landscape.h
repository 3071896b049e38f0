// SPDX-License-Identifier: Apache-2.0
// The land of the plants scene: a valley with a river that widens into a lake, between hills.
// Metres; y is up, the viewer stands near the origin and looks towards -z; the water lies at y = 0.
#pragma once

#include "core/vec.h"

namespace ovc::plants {

/// Where the viewer stands; vegetation is densest and most detailed around this point.
inline constexpr dvec2 kViewpoint{0.0, 4.0}; // x, z

/// The land reaches this far from the origin along x and z.
inline constexpr double kReach = 1400;

/// How far (x, z) lies from the water's edge, roughly: negative in the water.
double shore_distance(dvec2 at);

/// Height of the ground, of the river bed where there is water.
double ground_height(dvec2 at);

/// The rise of the ground over a metre, at its steepest.
double ground_slope(dvec2 at);

} // namespace ovc::plants
