// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/exact.h"

#include <algorithm>
#include <cmath>

namespace ovc::csg {

namespace {

int sign(const Int128& x) {
    return (x > 0) - (x < 0);
}

Int128 absolute(const Int128& x) {
    return x < 0 ? -x : x;
}

Wide product(const Int128& a, const Int128& b) {
    return Wide(a) * Wide(b);
}

/// Returns a b - c d.
Wide minor_of(const Int128& a, const Int128& b, const Int128& c, const Int128& d) {
    return product(a, b) - product(c, d);
}

void round(Point& p) {
    const Wide* homogeneous[3] = {&p.x, &p.y, &p.z};
    for (size_t i = 0; i < 3; ++i) {
        const Wide scaled = *homogeneous[i] << kFractionBits;
        p.rounded[i] = static_cast<int64_t>(Wide(scaled / p.w));
        p.near[int(i)] = std::ldexp(double(p.rounded[i]), -kFractionBits);
    }
}

} // namespace

Plane plane_through(const GridPoint& a, const GridPoint& b, const GridPoint& c) {
    Int128 u[3], v[3];
    for (size_t i = 0; i < 3; ++i) {
        u[i] = b[i] - a[i];
        v[i] = c[i] - a[i];
    }
    const Int128 x = u[1] * v[2] - u[2] * v[1], y = u[2] * v[0] - u[0] * v[2],
                 z = u[0] * v[1] - u[1] * v[0];
    return {x, y, z, -(x * a[0] + y * a[1] + z * a[2])};
}

Plane plane_along(int axis, const GridPoint& a, const GridPoint& b) {
    const size_t i = size_t(axis), j = (i + 1) % 3, k = (i + 2) % 3;
    Int128 n[3];
    n[i] = 0;
    n[j] = Int128(a[k]) - b[k];
    n[k] = Int128(b[j]) - a[j];
    return {n[0], n[1], n[2], -(n[j] * a[j] + n[k] * a[k])};
}

int major_axis_of(const Plane& plane) {
    int axis = 0;
    for (int i = 1; i < 3; ++i)
        if (absolute(plane.n[i]) > absolute(plane.n[axis]))
            axis = i;
    return axis;
}

Point point_of(const GridPoint& p) {
    return {Wide(p[0]), Wide(p[1]), Wide(p[2]),
            Wide(1),    rounded(p), dvec3(double(p[0]), double(p[1]), double(p[2]))};
}

std::array<int64_t, 3> rounded(const GridPoint& p) {
    constexpr int64_t kSteps = int64_t(1) << kFractionBits;
    return {p[0] * kSteps, p[1] * kSteps, p[2] * kSteps};
}

// Applies Cramer's rule with the second-order minors of b and c.
Point meet(const Plane& a, const Plane& b, const Plane& c) {
    const Int128 *u = b.n, *v = c.n;
    const Wide yz = minor_of(u[1], v[2], u[2], v[1]), zx = minor_of(u[2], v[0], u[0], v[2]),
               xy = minor_of(u[0], v[1], u[1], v[0]);
    const Wide dx = minor_of(b.d, v[0], c.d, u[0]), dy = minor_of(b.d, v[1], c.d, u[1]),
               dz = minor_of(b.d, v[2], c.d, u[2]);
    const Wide ax(a.n[0]), ay(a.n[1]), az(a.n[2]), ad(a.d);
    Point p;
    p.w = ax * yz + ay * zx + az * xy;
    p.x = ay * dz - az * dy - ad * yz;
    p.y = az * dx - ax * dz - ad * zx;
    p.z = ax * dy - ay * dx - ad * xy;
    if (p.w < 0) {
        p.x = -p.x;
        p.y = -p.y;
        p.z = -p.z;
        p.w = -p.w;
    }
    round(p);
    return p;
}

int side(const Plane& plane, const GridPoint& p) {
    const double x = plane.near[0] * double(p[0]), y = plane.near[1] * double(p[1]),
                 z = plane.near[2] * double(p[2]), value = x + y + z + plane.near[3];
    const double size = std::abs(x) + std::abs(y) + std::abs(z) + std::abs(plane.near[3]);
    if (std::abs(value) > size * 0x1p-49)
        return value > 0 ? 1 : -1;
    return sign(plane.n[0] * p[0] + plane.n[1] * p[1] + plane.n[2] * p[2] + plane.d);
}

// Doubles decide where their error allows it. `near` is off by less than 2^-kFractionBits in each
// coordinate, and ten roundings by 2^-53 of the largest term add up to less than 2^-49 of the sum
// of sizes.
int side(const Plane& plane, const Point& p) {
    double value = plane.near[3], size = std::abs(value), steep = 0;
    for (int i = 0; i < 3; ++i) {
        const double part = plane.near[i] * p.near[i];
        value += part;
        size += std::abs(part);
        steep += std::abs(plane.near[i]);
    }
    const double error = steep * 0x1p-12 + size * 0x1p-49;
    if (std::abs(value) > error)
        return value > 0 ? 1 : -1;
    const Wide exact = Wide(plane.n[0]) * p.x + Wide(plane.n[1]) * p.y + Wide(plane.n[2]) * p.z +
                       Wide(plane.d) * p.w;
    return exact.sign();
}

} // namespace ovc::csg
