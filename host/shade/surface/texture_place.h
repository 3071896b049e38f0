// SPDX-License-Identifier: Apache-2.0
// The place of a hit for textures: its texture coordinates, and the part of the surface that a ray
// sees there.
#pragma once

#include "host/shade/shade.h"

namespace ovc {

/// Sets everything except `at`. triangle: that was hit; width: of the ray's cone there; surface:
/// with its view and geometric normal.
void take_texture_place(const Scene& scene, const MeshInfo& mesh, const Triangle& triangle,
                        const Hit& hit, double width, const SurfacePoint& surface,
                        TexturePoint& point);

} // namespace ovc
