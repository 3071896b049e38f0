// SPDX-License-Identifier: Apache-2.0
// Makes a thousand closed glass shapes, blunt and sharp, for rays that start on surfaces.
#pragma once

#include "core/scene.h"

namespace ovc {

struct ShapeField {
    Scene scene;              // mesh i is shape i, with its own origin and corners counterclockwise
    std::vector<bool> convex; // exactly: its facets meet at angles far above a rounding
    double scale;             // shapes lie within 1.5 scales of their origins, which are 4 apart
};

/// Returns `count` shapes: in turn tetrahedra, stretched spheres, lat-long meshes of random radii,
/// boxes, plates and needles as thin as 1e-4. Every second group of six has vertex normals that
/// point anywhere outwards. Indices of refraction are 1 + 1e-12, 1 - 1e-12, 1.5, 1/1.5 and 1e3.
ShapeField make_shape_field(uint32_t count, double scale);

} // namespace ovc
