// SPDX-License-Identifier: Apache-2.0
// Aims rays at far-terrain and keeps those that must hit.
#include "host/suites/stability/terrain_rays.h"

#include <cmath>
#include <limits>

namespace ovc {

/// Returns a point of a random triangle of a random chunk. The chunk is drawn first, because each
/// has triangles of another size, and all sizes shall be as frequent.
static dvec3 target_on(const Soup& soup, Random& random) {
    const Chunk& chunk = soup.chunks[random.below(uint32_t(soup.chunks.size()))];
    const vec3* corner = &chunk.corners()[3 * size_t(random.below(chunk.size()))];
    const Triangle local = {dvec3(corner[0]), dvec3(corner[1]), dvec3(corner[2])};
    return chunk.origin() + point_of(local, random, Target::Any);
}

bool must_hit_ground(const Ray& ray, const Box& bounds) {
    double leaves = std::numeric_limits<double>::infinity();
    for (const int axis : {0, 2})
        if (ray.dir[axis] != 0) {
            const double face = ray.dir[axis] > 0 ? bounds.hi[axis] : bounds.lo[axis];
            leaves = std::min(leaves, (face - ray.org[axis]) / ray.dir[axis]);
        }
    // A metre is more than the error of doubles here.
    return ray.dir.y < 0 && ray.at(leaves).y < bounds.lo.y - 1;
}

AimedRays terrain_rays(const Soup& soup, Random& random, size_t count, double low, double high) {
    Box bounds;
    hittable_triangles(soup, nullptr, &bounds);
    const dvec3 corner(bounds.hi.x, 0, bounds.hi.z);
    AimedRays set;
    while (set.rays.size() < count) {
        Ray ray;
        // The hills around are not as high as 1 cm.
        const double above = std::pow(10.0, random.uniform(low, high));
        ray.org = corner + dvec3{-random.uniform(0.001, 0.05), above, -random.uniform(0.001, 0.05)};
        ray.dir = target_on(soup, random) - ray.org;
        if (must_hit_ground(ray, bounds))
            set.rays.push_back(ray);
    }
    return set;
}

} // namespace ovc
