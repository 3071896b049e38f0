// SPDX-License-Identifier: Apache-2.0
// Makes rays down at the test scene far-terrain from near its far corner.
#pragma once

#include "host/suites/stability/stability_rays.h"

namespace ovc {

/// Returns rays at vertices, edges and insides of triangles of all sizes, from a few centimetres
/// beside the corner of largest x and z and 10^low to 10^high m above it. The ground is a height
/// field over a square, and each ray leaves the square below its lowest point, so it must hit.
AimedRays terrain_rays(const Soup& soup, Random& random, size_t count, double low, double high);

/// Returns whether a ray from above the ground with these bounds leaves them sideways at least a
/// metre below their floor.
bool must_hit_ground(const Ray& ray, const Box& bounds);

} // namespace ovc
