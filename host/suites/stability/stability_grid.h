// SPDX-License-Identifier: Apache-2.0
// The grid of the stability suite is one strip of triangles at every pair of scale and offset, for
// several aspects.
#pragma once

#include "host/suites/stability/stability_cases.h"

#include <string>
#include <vector>

namespace ovc {

struct GridPoint {
    int aspect_power = 0; // triangles are 1 long and 10^-aspect_power high
    int scale_power = 0;  // the strip is scaled by 2^scale_power, which rounds nothing
    int offset_power = 0; // the strip is 10^offset_power lengths from the origin; -1: at it

    std::string name() const; // "strip: aspect 1e3, scale 2^20, offset 1e4"
};

/// Returns all points, ordered by aspect, then scale, then offset. quick: fewer scales.
std::vector<GridPoint> stability_grid(bool quick);

/// Returns a case for each point, in the same order: rays at vertices, edges and insides of the
/// strip's triangles, each of which must hit.
std::vector<StabilityCase> stability_grid_cases(bool quick);

} // namespace ovc
