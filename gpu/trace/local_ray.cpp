// SPDX-License-Identifier: Apache-2.0
// Converts rays to the frame of the top-level tree.
#include "gpu/trace/local_ray.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovc {
namespace {

/// Returns the part of the ray inside the box; empty if enter > exit. Inlined, for a call of its
/// own costs a third of local_ray().
[[gnu::always_inline]] inline Interval inside_box(const Box& box, const Ray& ray) {
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

/// Returns the max of a coordinate of rows v, with the signs that make it largest.
double reach_of(const std::array<dvec3, 3>& rows, const dvec3& v) {
    const dvec3 size = glm::abs(v);
    return std::max({glm::dot(glm::abs(rows[0]), size), glm::dot(glm::abs(rows[1]), size),
                     glm::dot(glm::abs(rows[2]), size)});
}

/// Returns how far a ray may be off, in doubles, from where it comes to a box within 2 of the
/// frame's origin: from farther away it may seem to miss it. reach, dir_reach: reach_of() its
/// origin and its direction.
double off_at_box(double reach, double dir_reach, double speed) {
    const double ratio = dir_reach / std::max(speed, 1e-300);
    return std::min((reach + (reach + 2) * ratio) * 0x1p-49, 1e290);
}

/// Returns the word of what a ray asks for.
uint32_t asks_of(uint32_t skip, bool any_hit) {
    return std::min<uint32_t>(skip, OVC_SKIPS_NONE) | (any_hit ? OVC_RAY_ANY_HIT : 0);
}

/// Returns LocalRay::t_end. inside: the part of the ray inside the box, which is `speed` times as
/// long in the frame. reach: how far from the frame's origin the sums in doubles have come.
float t_end_of(const Ray& ray, const Interval& inside, double speed, double reach) {
    if (!(inside.enter <= inside.exit && ray.t_max >= ray.t_min))
        return OVC_NO_RAY;
    const double length = (inside.exit - inside.enter) * speed;
    // Written so that a NaN is not decidable either.
    const bool decidable =
        reach <= OVC_MAX_LEAF_SIZES && length <= 1e30 && speed >= 1e-300 && speed <= 1e300;
    if (!decidable)
        return OVC_UNDECIDABLE;
    // Rounded up, past the amount that the conversion may have lost.
    return std::bit_cast<float>(std::bit_cast<uint32_t>(float(length)) + 2);
}

} // namespace

LocalRay local_ray(const Leaf& leaf, const Ray& ray, uint32_t skip, bool any_hit, LocalTime& time) {
    const double longest = largest(ray.dir);
    const double scale = leaf.frame.scale;
    const Interval inside = inside_box(leaf.box, ray);
    time = {inside.enter, longest * scale};

    LocalRay local;
    local.dir = vec3(ray.dir * (1 / longest));
    local.asks = asks_of(skip, any_hit);
    const dvec3 from_origin = ray.org - leaf.frame.origin;
    const dvec3 travelled = ray.dir * inside.enter;
    local.org = vec3((from_origin + travelled) * scale);
    local.t_end = t_end_of(ray, inside, time.speed,
                           std::max(largest(from_origin), largest(travelled)) * scale);
    return local;
}

LocalRay local_ray(const Portal& portal, const Ray& ray, uint32_t skip, bool any_hit,
                   LocalTime& time) {
    const dvec3 from_origin = ray.org - portal.origin;
    Ray there = ray;
    there.org = portal.to_local_direction(from_origin);
    there.dir = portal.to_local_direction(ray.dir);
    const double longest = largest(there.dir);
    const double reach = reach_of(portal.rows, from_origin);
    const double dir_reach = reach_of(portal.rows, ray.dir);
    const Interval inside =
        inside_box(portal.box.padded(off_at_box(reach, dir_reach, longest)), there);
    time = {inside.enter, longest};

    LocalRay local;
    local.dir = vec3(there.dir * (1 / longest));
    local.asks = asks_of(skip, any_hit);
    local.org = vec3(there.org + there.dir * inside.enter);
    local.t_end =
        t_end_of(ray, inside, longest, std::max(reach, dir_reach * std::abs(inside.enter)));
    return local;
}

} // namespace ovc
