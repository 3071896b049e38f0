// SPDX-License-Identifier: Apache-2.0
// Polygons that meet along edges, made triangles that do: where the corner of one lies on the edge
// of another, that gets a corner there as well.
#pragma once

#include "importers/csg/exact.h"

#include <vector>

namespace ovc::csg {

/// Corners in 2^-kFractionBits of the grid.
using Corner = std::array<int64_t, 3>;
/// A convex polygon; neighbouring edges are not in line.
using Outline = std::vector<Corner>;

struct Stitched {
    uint32_t outline; // the number of the one it is a part of
    std::array<Corner, 3> corners;
};

std::vector<Stitched> stitch(const std::vector<Outline>& outlines);

} // namespace ovc::csg
