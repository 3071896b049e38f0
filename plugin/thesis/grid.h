// SPDX-License-Identifier: Apache-2.0
// The uniform grid as texels. Based on: Thrane and Simonsen 2005, section 4.2; the resolution:
// Wald et al. 2006, "Ray Tracing Animated Scenes using Coherent Grid Traversal", section 4.1.
//
// texels 0..3  lower corner; size of a cell (float bits); cells along x, y, z; where cells,
//              references and triangles begin (texels)
// cells        two a texel, x fastest: first reference, end of the references
// references   four a texel: triangles
// triangles    three texels each
#pragma once

#include "plugin/thesis/system.h"

#include <array>

namespace ovc::thesis {

/// Returns the cells along each axis: about five a triangle (> 0), as nearly cubes as possible.
std::array<uint32_t, 3> grid_resolution(const dvec3& extent, uint64_t triangles);

/// Returns the grid, which lists every triangle in each cell that it touches when the cell is wider
/// by kWider.
Result<System> build_grid(const Soup& soup, const Leaf& whole, BuildProgress* progress = nullptr);

} // namespace ovc::thesis
