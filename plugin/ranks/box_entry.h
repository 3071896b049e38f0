// SPDX-License-Identifier: Apache-2.0
// EnteringRay tells where a ray comes into a box. Based on: Ize 2013, "Robust BVH Ray Traversal",
// section 3.
#pragma once

#include "core/box.h"
#include "core/ray.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace ovc {

/// The t of no entry.
inline constexpr double kNoEntry = std::numeric_limits<double>::infinity();

/// A ray made ready for boxes. It must be valid.
class EnteringRay {
public:
    explicit EnteringRay(const Ray& ray)
        : org_(ray.org), inv_(dvec3(1) / (ray.dir + 0.0)), t_min_(ray.t_min), t_max_(ray.t_max) {
        for (int axis = 0; axis < 3; ++axis) {
            goes_down_[axis] = ray.dir[axis] < 0;
            // Such an axis must not bound anything, but 1 / dir is too large to tell where it does.
            if (ray.dir[axis] != 0 && std::isinf(inv_[axis]))
                org_[axis] = std::numeric_limits<double>::quiet_NaN();
        }
    }

    /// Whether the ray comes into a box by its upper side along the axis.
    bool goes_down(int axis) const { return goes_down_[axis]; }

    /// Returns a lower bound of the smallest t in [t_min, t_max] at which the ray is in a closed
    /// box, and kNoEntry only where there is none; a ray that passes by narrowly may get a t as
    /// well. in, out: the sides by which it comes and goes along each axis.
    double entry(const dvec3& in, const dvec3& out) const {
        // A difference, a reciprocal and a product are each off by half a unit in the last place.
        constexpr double kLess = 1 - 0x1p-51, kMore = 1 + 0x1p-51;
        double near = t_min_, far = t_max_;
        for (int axis = 0; axis < 3; ++axis) {
            // NaN bounds nothing: max and min keep what they have.
            near = std::max(near, (in[axis] - org_[axis]) * inv_[axis]);
            far = std::min(far, (out[axis] - org_[axis]) * inv_[axis]);
        }
        near *= near > 0 ? kLess : kMore;
        far *= far > 0 ? kMore : kLess;
        return near <= far ? near : kNoEntry; // infinite where the ray runs beside the box
    }
    double entry(const Box& box) const {
        dvec3 in = box.lo, out = box.hi;
        for (int axis = 0; axis < 3; ++axis)
            if (goes_down_[axis])
                std::swap(in[axis], out[axis]);
        return entry(in, out);
    }

private:
    dvec3 org_, inv_;
    double t_min_, t_max_;
    bool goes_down_[3];
};

inline double box_entry(const Ray& ray, const Box& box) {
    return EnteringRay(ray).entry(box);
}

} // namespace ovc
