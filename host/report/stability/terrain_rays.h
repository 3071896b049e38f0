// SPDX-License-Identifier: Apache-2.0
// Rays down at the test scene far-terrain from near its far corner.
#pragma once

#include "host/report/stability/stability_rays.h"

namespace ovc {

/// Aimed at vertices, edges and insides of triangles of all sizes, from a few centimetres beside
/// the corner of largest x and z and 10^low ... 10^high m above it. The ground is a height field
/// over a square, and each ray leaves the square below the lowest of it, so it must hit.
AimedRays terrain_rays(const Soup& soup, Random& random, size_t count, double low, double high);

/// Whether a ray from above the ground of `bounds` is below all of it before it is beside it.
bool must_hit_ground(const Ray& ray, const Box& bounds);

} // namespace ovc
