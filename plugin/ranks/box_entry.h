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

/// Returns a lower bound of the smallest t in [t_min, t_max] at which a valid ray is in the closed
/// box, and kNoEntry only where there is none; a ray that passes by narrowly may get a t as well.
inline double box_entry(const Ray& ray, const Box& box) {
    // A difference and a quotient are each off by half a unit in the last place at most.
    constexpr double kLess = 1 - 0x1p-51, kMore = 1 + 0x1p-51;
    double near = ray.t_min, far = ray.t_max;
    for (int axis = 0; axis < 3; ++axis) {
        const double to_lo = box.lo[axis] - ray.org[axis];
        const double to_hi = box.hi[axis] - ray.org[axis];
        const double dir = ray.dir[axis];
        if (dir == 0) {
            if (to_lo > 0 || to_hi < 0)
                return kNoEntry;
            continue;
        }
        const double in = (dir > 0 ? to_lo : to_hi) / dir;
        const double out = (dir > 0 ? to_hi : to_lo) / dir;
        near = std::max(near, in > 0 ? in * kLess : in * kMore);
        far = std::min(far, out > 0 ? out * kMore : out * kLess);
    }
    return near <= far ? std::min(near, std::numeric_limits<double>::max()) : kNoEntry;
}

} // namespace ovc
