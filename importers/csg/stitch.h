// SPDX-License-Identifier: Apache-2.0
// Turns polygons that meet along edges into triangles that do. If the corner of a polygon lies on
// the edge of another, the other gets a corner there as well.
#pragma once

#include "importers/csg/exact.h"

#include <vector>

namespace ovc::csg {

/// A corner in units of 2^-kFractionBits of the grid.
using Corner = std::array<int64_t, 3>;
/// A convex polygon. Neighbouring edges are not in line.
using Outline = std::vector<Corner>;

struct Stitched {
    uint32_t outline; // the number of the outline that the triangle is a part of
    std::array<Corner, 3> corners;
};

std::vector<Stitched> stitch(const std::vector<Outline>& outlines);

} // namespace ovc::csg
