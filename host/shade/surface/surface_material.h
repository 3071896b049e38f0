// SPDX-License-Identifier: Apache-2.0
// The material of a surface at a point: evaluates its texture, its layers and its mix.
#pragma once

#include "host/shade/shade.h"

namespace ovc {

/// Sets what the surface takes from Scene::materials[material], or from a plain one where there is
/// no such material: material, color, maps, opacity, through, coats; and tilts its
/// normal. point: in the world, with the surface's normal and view.
void take_material(const Scene& scene, uint32_t material, const TexturePoint& point,
                   SurfacePoint& surface);

} // namespace ovc
