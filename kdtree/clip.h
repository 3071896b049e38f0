// SPDX-License-Identifier: Apache-2.0
// The bounds of the part of a triangle inside a box. Based on: Sutherland and Hodgman 1974.
#pragma once

#include "core/box.h"
#include "core/soup.h"

#include <array>

namespace ovc {

/// Returns the box of triangle ∩ box, larger by at most a few roundings and never smaller; it is
/// empty only when the two are apart.
inline Box clipped_bounds(const Triangle& triangle, const Box& box) {
    // A triangle cut by six planes has at most nine corners.
    std::array<dvec3, 10> from;
    std::array<dvec3, 10> to;
    int count = 3;
    std::copy(triangle.begin(), triangle.end(), from.begin());
    for (int plane = 0; plane < 6 && count > 0; ++plane) {
        const int axis = plane >> 1;
        const bool upper = plane & 1;
        const double limit = upper ? box.hi[axis] : box.lo[axis];
        const double sign = upper ? -1.0 : 1.0;
        int kept = 0;
        for (int i = 0; i < count; ++i) {
            const dvec3& a = from[i];
            const dvec3& b = from[i + 1 < count ? i + 1 : 0];
            const double da = sign * (a[axis] - limit);
            const double db = sign * (b[axis] - limit);
            if (da >= 0)
                to[kept++] = a;
            if ((da < 0) != (db < 0)) {
                dvec3 cut = a + (da / (da - db)) * (b - a);
                cut[axis] = limit;
                to[kept++] = cut;
            }
        }
        count = kept;
        std::swap(from, to);
    }
    Box bounds;
    for (int i = 0; i < count; ++i)
        bounds.add(from[i]);
    if (bounds.empty())
        return bounds;
    // The cuts are rounded; a few ulp of the triangle's coordinates cover that.
    const Box whole = bounds_of(triangle);
    const double margin = 0x1p-50 * max_component(glm::max(glm::abs(whole.lo), glm::abs(whole.hi)));
    return bounds.padded(margin).intersection(whole).intersection(box);
}

} // namespace ovc
