// SPDX-License-Identifier: Apache-2.0
// A hit on the side opposite to corner i has no weight there; going on from that corner through the
// hit leads out of the triangle.
#include "plugin/hosts/tachyon/beside.h"

#include <algorithm>
#include <cmath>

namespace ovc::tachyon {

static constexpr double kOnSide = 1e-8; // weights are off by less, even far away and at a slant
static constexpr double kAcross = 1e-7;
static constexpr double kBefore = 1e-4; // in lengths of the triangle: what lies across may be steep

using Vector = std::array<double, 3>;

/// Returns the way from each corner to the hit, in units of the triangle.
static std::array<Vector, 3> to_hit(const ovc_hit& hit, const Triangle& t) {
    const auto from_corner = [&](double u, double v) {
        return Vector{u * t.edge1.x + v * t.edge2.x, u * t.edge1.y + v * t.edge2.y,
                      u * t.edge1.z + v * t.edge2.z};
    };
    return {from_corner(hit.u, hit.v), from_corner(hit.u - 1, hit.v),
            from_corner(hit.u, hit.v - 1)};
}

static ovc_ray shifted(const ovc_ray& ray, const ovc_hit& hit, const Vector& way) {
    ovc_ray beside = ray;
    for (size_t axis = 0; axis < 3; ++axis)
        beside.org[axis] += kAcross * way[axis];
    const double length = std::hypot(way[0], way[1], way[2]);
    const double speed = std::hypot(ray.dir[0], ray.dir[1], ray.dir[2]);
    beside.t_min = std::max<double>(EPSILON, hit.t - kBefore * length / speed);
    return beside;
}

RaysBeside rays_beside(const ovc_ray& ray, const ovc_hit& hit, const Triangle& triangle) {
    const double weights[3] = {1 - hit.u - hit.v, hit.u, hit.v};
    RaysBeside beside;
    if (*std::min_element(weights, weights + 3) > kOnSide)
        return beside;
    const std::array<Vector, 3> ways = to_hit(hit, triangle);
    Vector both{};
    for (size_t i = 0; i < 3; ++i) {
        if (weights[i] > kOnSide)
            continue;
        beside.rays[beside.count++] = shifted(ray, hit, ways[i]);
        for (size_t axis = 0; axis < 3; ++axis)
            both[axis] += ways[i][axis];
    }
    if (beside.count == 2)
        beside.rays[beside.count++] = shifted(ray, hit, both);
    return beside;
}

} // namespace ovc::tachyon
