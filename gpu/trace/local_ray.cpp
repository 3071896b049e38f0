// SPDX-License-Identifier: Apache-2.0
// Converts rays to the frame of the top-level tree.
#include "gpu/trace/local_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovc {
namespace {

/// Returns the part of the ray inside the box; empty if enter > exit.
Interval inside_box(const Box& box, const Ray& ray) {
    Interval inside{ray.t_min, ray.t_max};
    for (int axis = 0; axis < 3; ++axis) {
        const double org = ray.org[axis];
        if (ray.dir[axis] == 0) {
            if (org < box.lo[axis] || org > box.hi[axis])
                return {1, 0};
            continue;
        }
        const double inv_dir = 1 / ray.dir[axis];
        const double a = (box.lo[axis] - org) * inv_dir, b = (box.hi[axis] - org) * inv_dir;
        inside.enter = std::max(inside.enter, std::min(a, b));
        inside.exit = std::min(inside.exit, std::max(a, b));
    }
    return inside;
}

double largest(const dvec3& v) {
    return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

} // namespace

LocalRay local_ray(const Leaf& leaf, const Ray& ray, uint32_t skip, bool any_hit, LocalTime& time) {
    const double longest = largest(ray.dir);
    const double scale = leaf.frame.scale;
    const Interval inside = inside_box(leaf.box, ray);
    time = {inside.enter, longest * scale};

    LocalRay local;
    local.dir = vec3(ray.dir * (1 / longest));
    local.asks = std::min<uint32_t>(skip, OVC_SKIPS_NONE) | (any_hit ? OVC_RAY_ANY_HIT : 0);
    const dvec3 from_origin = ray.org - leaf.frame.origin;
    const dvec3 travelled = ray.dir * inside.enter;
    local.org = vec3((from_origin + travelled) * scale);
    const double length = (inside.exit - inside.enter) * time.speed;
    // Rounded up, past the amount that the conversion may have lost.
    local.t_end = std::bit_cast<float>(std::bit_cast<uint32_t>(float(length)) + 2);
    const double reach = std::max(largest(from_origin), largest(travelled)) * scale;
    // Written so that a NaN is not decidable either.
    const bool decidable = reach <= OVC_MAX_LEAF_SIZES && length <= 1e30 && time.speed >= 1e-300 &&
                           time.speed <= 1e300;
    if (!decidable)
        local.t_end = OVC_UNDECIDABLE;
    if (!(inside.enter <= inside.exit && ray.t_max >= ray.t_min))
        local.t_end = OVC_NO_RAY;
    return local;
}

} // namespace ovc
