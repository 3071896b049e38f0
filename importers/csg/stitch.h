// SPDX-License-Identifier: Apache-2.0
// Polygons that meet along edges, made triangles that do: where the corner of one lies on the edge
// of another, that gets a corner there as well.
#pragma once

#include "importers/csg/cut.h"

namespace ovc::csg {

/// Corners in 2^-kFractionBits of the grid; as many as the polygon of that number is cut into.
struct Stitched {
    uint32_t polygon;
    std::array<std::array<int64_t, 3>, 3> corners;
};

std::vector<Stitched> stitch(const std::vector<Polygon>& polygons);

} // namespace ovc::csg
