// SPDX-License-Identifier: Apache-2.0
// CullBatch and RayCull: make triangles and rays ready for cull().
#include "core/lanes/cull_batch.h"

#include "core/exact/double_parts.h"
#include "core/exact/exact.h"
#include "core/exact/rounding.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

Vec3Of<double> components(const dvec3& v) {
    return {v.x, v.y, v.z};
}

void put(double (&to)[3], double x, double y, double z) {
    to[0] = x;
    to[1] = y;
    to[2] = z;
}
void put(double (&to)[3], const dvec3& v) {
    put(to, v.x, v.y, v.z);
}

double largest(const dvec3& v) {
    return max_component(glm::abs(v));
}

double size_of(const Triangle& triangle) {
    return std::max(largest(triangle[1] - triangle[0]), largest(triangle[2] - triangle[0]));
}

/// Where the ray comes from far away, differences to its origin would lose the triangles.
void set_reference(CullRay& ray, const Ray& line, const Triangle& near) {
    put(ray.reference, line.org);
    if (!(largest(line.org - near[0]) > 1024 * size_of(near)))
        return;
    const Vec3Of<Exact> moment = cross(exact(line.org) - exact(near[0]), exact(line.dir));
    dvec3 high(0), low(0);
    int axis = 0;
    for (const Exact& part : {moment.x, moment.y, moment.z}) {
        high[axis] = Exact::quotient(part, Exact(1));
        low[axis] = Exact::quotient(part - Exact(high[axis]), Exact(1));
        ++axis;
    }
    if (!(largest(high) < 1e300))
        return; // it may lie beyond all doubles
    put(ray.reference, near[0]);
    put(ray.moment_high, high);
    put(ray.moment_low, low);
}

using Difference = Vec3Of<DoubleDouble>;

/// Returns the exponent of a power of two that all components are multiples of. At least one is not
/// 0.
int power_of(const Difference& a, const Difference& b) {
    int power = std::numeric_limits<int>::max();
    for (const Difference* d : {&a, &b})
        for (const double part : {d->x.hi, d->x.lo, d->y.hi, d->y.lo, d->z.hi, d->z.lo})
            if (const DoubleParts x(part); x.mantissa != 0)
                power = std::min(power, x.power + std::countr_zero(x.mantissa));
    return power;
}

/// Returns the exponent of the unit that distances from the plane of a triangle with these sides
/// count in. The smaller it is, the more corners of other triangles are multiples; but products of
/// three lengths must stay below 2^112 for doubles to tell when integers of 64 bits do.
int unit_of(const Difference& ab, const Difference& ac, bool& is_multiple) {
    double reach = 0;
    for (const Difference* d : {&ab, &ac})
        reach = std::max({reach, std::abs(d->x.hi), std::abs(d->y.hi), std::abs(d->z.hi)});
    const int exponent = std::ilogb(reach) + 1, own = power_of(ab, ac);
    is_multiple = own >= exponent - 36;
    return is_multiple ? std::max(exponent - 36, own - 16) : exponent;
}

Difference scaled(const Difference& d, double by) {
    const auto times = [&](const DoubleDouble& x) { return DoubleDouble{x.hi * by, x.lo * by}; };
    return {times(d.x), times(d.y), times(d.z)};
}

/// Returns integers below 2^51 modulo 2^64.
Vec3Of<uint64_t> integers(const Difference& d) {
    return {uint64_t(int64_t(d.x.hi)), uint64_t(int64_t(d.y.hi)), uint64_t(int64_t(d.z.hi))};
}

void set_plane(CullRay& ray, const PreparedRay& p, const Triangle& triangle) {
    const Difference ab = exact_difference(components(triangle[1]), components(triangle[0]));
    const Difference ac = exact_difference(components(triangle[2]), components(triangle[0]));
    ray.per_unit = std::ldexp(1.0, -unit_of(ab, ac, ray.has_units));
    const Difference u = scaled(ab, ray.per_unit), v = scaled(ac, ray.per_unit);
    const Difference normal = cross(u, v);
    const Vec3Of<MagnitudeOf<double>> size = cross(magnitudes(u), magnitudes(v));
    const Vec3Of<double> dir = components(p.ray.dir);
    const double along = dot(normal, dir).hi;
    const double error = 0x1p-101 * dot(size, magnitudes(dir)).value + 0x1p-1000 +
                         0x1p-1000 * total(magnitudes(dir));
    ray.has_plane = std::isfinite(along) && std::abs(along) > error;
    const double sign = along < 0 ? -1 : 1;
    put(ray.normal_high, sign * normal.x.hi, sign * normal.y.hi, sign * normal.z.hi);
    put(ray.normal_low, sign * normal.x.lo, sign * normal.y.lo, sign * normal.z.lo);
    put(ray.normal_size, size.x.value, size.y.value, size.z.value);
    if (!ray.has_units)
        return;
    const Vec3Of<uint64_t> exactly = cross(integers(u), integers(v));
    const uint64_t turned = along < 0 ? ~uint64_t(0) : 1; // -1 modulo 2^64
    ray.normal_in_units[0] = turned * exactly.x;
    ray.normal_in_units[1] = turned * exactly.y;
    ray.normal_in_units[2] = turned * exactly.z;
}

} // namespace

CullRay cull_ray(const PreparedRay& p, const Triangle& near) {
    CullRay ray{};
    ray.kx = p.kx;
    ray.ky = p.ky;
    ray.kz = p.kz;
    ray.sx = p.sx;
    ray.sy = p.sy;
    ray.sz = p.sz;
    put(ray.org, p.ray.org);
    put(ray.dir, p.ray.dir);
    ray.t_min = p.ray.t_min;
    ray.t_max = p.ray.t_max;
    set_reference(ray, p.ray, near);
    return ray;
}

void note_hit(CullRay& ray, const PreparedRay& p, const ComparedHit& nearest) {
    const Candidate& found = nearest.found;
    ray.has_hit = true;
    ray.t = found.hit.t;
    ray.t_low = found.t_low;
    ray.t_error = found.t_error;
    ray.key = key_of(found.hit.id);
    ray.support_count = 0;
    for (int i = 0; i < 3; ++i) {
        put(ray.corner[i], nearest.triangle[size_t(i)]);
        if (found.support != Candidate::kAllCorners && (found.support >> i & 1))
            ray.support[ray.support_count++] = i;
    }
    if (ray.support_count == 1)
        ray.support[1] = ray.support[0];
    set_plane(ray, p, nearest.triangle);
}

Triangle CullBatch::triangle(uint32_t i) const {
    const CullLanes& lanes = lanes_[i / kLanes];
    Triangle triangle;
    for (size_t corner = 0; corner < 3; ++corner)
        for (size_t axis = 0; axis < 3; ++axis)
            triangle[corner][int(axis)] = lanes.corner[corner][axis][i % kLanes];
    return triangle;
}

Triangle CullBatch::smallest() const {
    assert(count_ > 0);
    Triangle smallest = triangle(0);
    for (uint32_t i = 1; i < count_; ++i)
        if (const Triangle other = triangle(i); size_of(other) < size_of(smallest))
            smallest = other;
    return smallest;
}

uint64_t RayCull::cull_all(CullBatch& batch, uint64_t left) {
    if (!ray_)
        ray_ = cull_ray(p_, batch.smallest());
    if (has_new_hit()) {
        note_hit(*ray_, p_, nearest_.best());
        noted_ = nearest_.best().found.hit.id;
    }
    uint64_t result = 0;
    for (uint32_t i = 0; i < batch.lanes_.size(); ++i) {
        const uint64_t asked = left >> i * kLanes & CullLanes::kAll;
        if (asked != 0)
            result |= (cull(*ray_, batch.lanes_[i]) & asked) << i * kLanes;
    }
    return result;
}

uint32_t RayCull::first_of(const CullBatch& batch, uint64_t left) {
    uint32_t first = 0;
    double lead = 0;
    for (bool any = false; left != 0; left &= left - 1) {
        const uint32_t i = uint32_t(std::countr_zero(left));
        const double own = batch.lanes_[i / kLanes].lead[i % kLanes];
        if (!any || own < lead || (own == lead && batch.ids_[i] < batch.ids_[first])) {
            first = i;
            lead = own;
        }
        any = true;
    }
    return first;
}

} // namespace ovc
