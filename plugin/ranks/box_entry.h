// SPDX-License-Identifier: Apache-2.0
// box_entry(): where a ray comes into a box. Based on: Ize 2013, "Robust BVH Ray Traversal",
// section 3.
#pragma once

#include "core/box.h"
#include "core/ray.h"

#include <algorithm>
#include <limits>

namespace ovc {

/// The t of no entry.
inline constexpr double kNoEntry = std::numeric_limits<double>::infinity();

/// Returns a t that is made of a difference, a reciprocal and a product, each off by half a unit in
/// the last place at most, moved by more than that error in the direction of the sign.
inline double with_margin(double t, int sign) {
    constexpr double kLess = 1 - 0x1p-51, kMore = 1 + 0x1p-51;
    return t * ((t > 0) == (sign > 0) ? kMore : kLess);
}

/// Returns a lower bound of the smallest t in [t_min, t_max] at which a valid ray is in the closed
/// box, and kNoEntry only where there is none; a ray that passes by narrowly may get a t as well.
inline double box_entry(const Ray& ray, const Box& box) {
    double near = ray.t_min, far = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double to_lo = box.lo[axis] - ray.org[axis];
        const double to_hi = box.hi[axis] - ray.org[axis];
        if (ray.dir[axis] == 0) {
            if (to_lo > 0 || to_hi < 0)
                return kNoEntry;
            continue;
        }
        const double inv = 1 / ray.dir[axis];
        // 0 times infinity is NaN, which bounds nothing: max and min keep what they have.
        near = std::max(near, (inv > 0 ? to_lo : to_hi) * inv);
        far = std::min(far, (inv > 0 ? to_hi : to_lo) * inv);
    }
    near = with_margin(near, -1);
    return near <= with_margin(far, 1) ? std::min(near, std::numeric_limits<double>::max())
                                       : kNoEntry;
}

} // namespace ovc
