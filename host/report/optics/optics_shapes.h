// SPDX-License-Identifier: Apache-2.0
// A thousand closed glass shapes, blunt and sharp, for rays that start on surfaces.
#pragma once

#include "core/scene.h"

namespace ovc {

struct ShapeField {
    Scene scene;              // mesh i is shape i, of its own origin, corners counterclockwise
    std::vector<bool> convex; // exactly: its facets meet at angles far above a rounding
    double scale;             // each shape lies within 1.5 scales of its origin, at least 4 apart
};

/// In turn tetrahedra, stretched spheres, lat-long meshes of random radii, boxes, plates and
/// needles as thin as 1e-4; every second one with vertex normals that point anywhere outwards.
/// Indices of refraction 1 + 1e-12, 1 - 1e-12, 1.5, 1/1.5 and 1e3.
ShapeField make_shape_field(uint32_t count, double scale);

} // namespace ovc
