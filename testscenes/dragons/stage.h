// SPDX-License-Identifier: Apache-2.0
// The dragon scenes share these: a model scaled to fit, and the path around them.
#pragma once

#include "testscenes/camera_path.h"
#include "testscenes/tube.h"

#include <cstdint>

namespace ovc::dragons {

/// Returns `given`, or the generated dragon of `triangles` if it is null, scaled and moved to fit
/// `room` and standing on y = 0 in the middle of x and z. given: at least one of its triangles can
/// be hit.
Surface make_model(const Soup* given, uint64_t triangles, const dvec3& room, bool with_normals);

/// Returns 100 frames once around a place `reach` wide, up and down by a sine, as in the thesis'
/// figure 4.2.
CameraPath circling_path(double reach);

/// Makes the ground that all dragons stand on, or the water: `cells_x` x `cells_z` cells from -half
/// to half, two triangles each, at height(x, z). Normals are those of the heights.
Surface make_sheet(uint32_t cells_x, uint32_t cells_z, double half, bool with_normals,
                   double (*height)(dvec2 at));

} // namespace ovc::dragons
