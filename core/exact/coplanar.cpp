// SPDX-License-Identifier: Apache-2.0
// Computes volumes of tetrahedra in integers of 128 bits, which wrap around: a volume that is 0
// there is 0 if doubles say that it is small.
#include "core/exact/coplanar.h"

#include "core/exact/double_parts.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {
namespace {

__extension__ using Wide = unsigned __int128;
using Integer3 = std::array<int64_t, 3>;

/// Returns the largest power of two that all coordinates are multiples of. At least one is not 0.
int unit_of(const Triangle& a, const Triangle& b) {
    int unit = std::numeric_limits<int>::max();
    for (const Triangle* triangle : {&a, &b})
        for (const dvec3& corner : *triangle)
            for (int axis = 0; axis < 3; ++axis)
                if (const DoubleParts x(corner[axis]); x.mantissa != 0)
                    unit = std::min(unit, x.power + std::countr_zero(x.mantissa));
    assert(unit != std::numeric_limits<int>::max());
    return unit;
}

/// Returns x / 2^unit, an integer, modulo 2^64.
uint64_t wrapped(double x, int unit) {
    const DoubleParts parts(x);
    const int shift = parts.power - unit;
    if (parts.mantissa == 0 || shift >= 64)
        return 0;
    const uint64_t magnitude = shift < 0 ? parts.mantissa >> -shift : parts.mantissa << shift;
    return x < 0 ? 0 - magnitude : magnitude;
}

/// Returns (to - from) / 2^unit, which is less than 2^58 in each coordinate.
Integer3 difference(const dvec3& to, const dvec3& from, int unit) {
    Integer3 result;
    for (size_t i = 0; i < 3; ++i)
        result[i] = int64_t(wrapped(to[int(i)], unit) - wrapped(from[int(i)], unit));
    return result;
}

Wide product(Wide a, int64_t b) {
    return a * Wide(b);
}

bool share_axis_plane(const Triangle& a, const Triangle& b) {
    for (int axis = 0; axis < 3; ++axis) {
        const double at = a[0][axis];
        if (a[1][axis] == at && a[2][axis] == at && b[0][axis] == at && b[1][axis] == at &&
            b[2][axis] == at)
            return true;
    }
    return false;
}

} // namespace

bool surely_coplanar(const Triangle& a, const Triangle& b) {
    if (share_axis_plane(a, b))
        return true;
    const dvec3 ab = a[1] - a[0], ac = a[2] - a[0];
    const dvec3 normal = glm::cross(ab, ac);
    double reach = max_component(glm::max(glm::abs(ab), glm::abs(ac)));
    for (const dvec3& corner : b)
        reach = std::max(reach, max_component(glm::abs(corner - a[0])));
    if (!(reach > 1e-90 && reach < 1e90))
        return false; // volumes might overflow or underflow
    // A volume is a sum of six products of three, of each of which doubles lose less than 2^-49.
    const double error = 6 * 0x1p-49 * reach * reach * reach;
    for (const dvec3& corner : b)
        if (!(std::abs(glm::dot(normal, corner - a[0])) <= error))
            return false;
    // So a volume is at most 2^-45 reach^3: less than 2^128 units where reach is less than 2^57.
    const int unit = unit_of(a, b);
    if (!(reach < std::ldexp(0x1p57, unit)))
        return false;
    const Integer3 u = difference(a[1], a[0], unit), v = difference(a[2], a[0], unit);
    std::array<Wide, 3> n;
    for (size_t i = 0; i < 3; ++i) {
        const size_t j = (i + 1) % 3, k = (i + 2) % 3;
        n[i] = product(Wide(u[j]), v[k]) - product(Wide(u[k]), v[j]);
    }
    return std::ranges::all_of(b, [&](const dvec3& corner) {
        const Integer3 w = difference(corner, a[0], unit);
        return product(n[0], w[0]) + product(n[1], w[1]) + product(n[2], w[2]) == 0;
    });
}

} // namespace ovc
