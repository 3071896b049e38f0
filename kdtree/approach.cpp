// SPDX-License-Identifier: Apache-2.0
// Approach: exact arithmetic moves a far ray's origin beside the scene.
#include "kdtree/approach.h"

#include "core/exact/exact.h"
#include "kdtree/partition.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

constexpr double kLargest = std::numeric_limits<double>::max();

double rounded(const Exact& x) {
    return Exact::quotient(x, Exact(1));
}
double down(double x) {
    return std::nextafter(x, -kLargest);
}
double up(double x) {
    return std::nextafter(x, kLargest);
}

/// Returns a t at which coordinate `axis` of the ray is within `error` of `goal`, as a sum of
/// doubles, because one double has too few bits where the ray comes from afar. Where that t lies
/// beyond all doubles, as the middle of a large scene may, returns one on the way there.
Exact t_at(const Ray& ray, int axis, double goal, double error) {
    assert(ray.dir[axis] != 0 && error >= 0);
    constexpr int kMaxSteps = 64; // each adds 52 bits, of 2,100 that doubles span
    const Exact dir(ray.dir[axis]);
    Exact t, rest = Exact(goal) - Exact(ray.org[axis]);
    for (int i = 0; i < kMaxSteps; ++i) {
        const double left = rounded(rest);
        if (std::abs(left) <= error)
            return t;
        const Exact step(std::clamp(left / ray.dir[axis], -kLargest, kLargest));
        t = t + step;
        rest = rest - step * dir;
    }
    return t;
}

/// Returns the direction without the components that do not move the ray within a scene.
dvec3 main_direction(const dvec3& dir) {
    dvec3 kept = dir;
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(dir[axis]) < 0x1p-200 * max_component(glm::abs(dir)))
            kept[axis] = 0;
    return kept;
}

bool is_near(const PreparedRay& p, const Box& bounds) {
    return has_walked_direction(p) && p.margin(bounds) <= padding_of(bounds);
}

} // namespace

Approach::Approach(const PreparedRay& p, const Box& bounds) : p_(p) {
    if (bounds.empty() || is_near(p, bounds))
        return;
    const double error = 0x1p-60 * max_component(bounds.extent());
    const Exact t = t_at(p.ray, p.kz, bounds.center()[p.kz], error);
    Ray ray = p.ray;
    for (int axis = 0; axis < 3; ++axis)
        ray.org[axis] = rounded(Exact(p.ray.org[axis]) + t * Exact(p.ray.dir[axis]));
    const int exponent = std::ilogb(p.ray.dir[p.kz]);
    const Exact unit(std::ldexp(1.0, -exponent)); // of t along the new direction
    ray.dir = glm::ldexp(main_direction(p.ray.dir), glm::ivec3(-exponent));
    ray.t_min = down(Exact::quotient(Exact(p.ray.t_min) - t, unit));
    ray.t_max = up(Exact::quotient(Exact(p.ray.t_max) - t, unit));
    moved_.emplace(ray, p.skip);
    moved_->org_error = 0x1p-52 * max_component(glm::abs(ray.org)) + 0x1p-1022;
    limit_ = ray.t_max;
}

void Approach::note_hit(const Triangle& triangle) {
    if (!moved_)
        return;
    const Ray& ray = moved_->ray;
    double latest = -kLargest; // t of the corners, and so of any point of the triangle
    for (const dvec3& corner : triangle)
        latest = std::max(latest, (corner[p_.kz] - ray.org[p_.kz]) / ray.dir[p_.kz]);
    const double margin = moved_->margin(bounds_of(triangle)) / std::abs(ray.dir[p_.kz]);
    limit_ = std::min(limit_, latest + margin + 0x1p-50 * std::abs(latest));
}

} // namespace ovc
