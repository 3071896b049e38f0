// SPDX-License-Identifier: Apache-2.0
// What the dragon scenes share: a model made to fit, and the path round them.
#pragma once

#include "testscenes/camera_path.h"
#include "testscenes/tube.h"

#include <cstdint>

namespace ovc::dragons {

/// The model to show: `given` where there is one, else the generated dragon of `triangles`. Scaled
/// and moved to fit `room`, standing on y = 0 in the middle of x and z. given: at least one of its
/// triangles can be hit.
Surface make_model(const Soup* given, uint64_t triangles, const dvec3& room, bool with_normals);

/// 100 frames once round a place `reach` wide, up and down by a sine, as in the thesis' figure 4.2.
CameraPath circling_path(double reach);

/// The ground plane that all dragons stand on, or the water: `cells_x` x `cells_z` cells from -half
/// to half, two triangles each, at height(x, z). Normals are those of the heights.
Surface make_sheet(uint32_t cells_x, uint32_t cells_z, double half, bool with_normals,
                   double (*height)(dvec2 at));

} // namespace ovc::dragons
