// SPDX-License-Identifier: Apache-2.0
// Where the plants of the plants scene stand: by height, slope and distance to the water, densest
// near the viewer.
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

/// All plants; `density` 1 is the demo scene's, 2 has twice as many plants.
std::vector<Plant> place_plants(double density);

} // namespace ovc::plants
