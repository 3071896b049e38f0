// SPDX-License-Identifier: Apache-2.0
// The grid of the stability suite: one strip of triangles at every pair of scale and offset, for
// several aspects.
#pragma once

#include "host/report/stability/stability_cases.h"

#include <string>
#include <vector>

namespace ovc {

struct GridPoint {
    int aspect_power = 0; // triangles are 1 long and 10^-aspect_power high
    int scale_power = 0;  // times 2^scale_power, which rounds nothing
    int offset_power = 0; // of ten: how many lengths from the origin; -1: none

    std::string name() const; // "strip: aspect 1e3, scale 2^20, offset 1e4"
};

/// By aspect, then scale, then offset. quick: fewer scales.
std::vector<GridPoint> stability_grid(bool quick);

/// A case for each point, in the same order: rays through the strip, at edges and insides, each of
/// which must hit.
std::vector<StabilityCase> stability_grid_cases(bool quick);

} // namespace ovc
