// SPDX-License-Identifier: Apache-2.0
// Places the plants of the plants scene by height, slope and distance to the water, densest near
// the viewer.
#pragma once

#include "testscenes/plants/species.h"

#include <vector>

namespace ovc::plants {

struct Plant {
    Kind kind;
    uint8_t tint;
    uint8_t variant;
    double size; // a factor
    double turn; // around the vertical, in turns
    dvec3 at;
};

/// Returns all plants. With `density` 1 they are the demo scene's, with 2 there are twice as many.
std::vector<Plant> place_plants(double density);

} // namespace ovc::plants
