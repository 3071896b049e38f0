// SPDX-License-Identifier: Apache-2.0
// chunk_origin() chooses one origin for the chunks of a file, so that single-precision offsets lose
// as little as possible.
#pragma once

#include "core/box.h"

#include <cassert>
#include <cmath>

namespace ovc {

/// Returns, per axis, the middle of `bounds` if that is farther from 0 than `far` (1 or more) times
/// the longest extent, else 0, because coordinates near 0 may be finer than the bounds tell. The
/// middle is rounded to 1/256 of the extent, so that coordinates which are short binary fractions
/// keep exact offsets. One origin serves a whole file: with two, meshes that share corners would
/// come apart.
inline dvec3 chunk_origin(const Box& bounds, double far) {
    assert(far >= 1);
    const double extent = max_component(bounds.extent());
    if (bounds.empty() || !(extent < 1e300))
        return dvec3(0);
    const dvec3 middle = bounds.center();
    const double grid =
        std::ldexp(1.0, (extent > 0 ? std::ilogb(extent)
                                    : std::ilogb(max_component(glm::abs(middle)) + 1e-300)) -
                            8);
    dvec3 origin(0);
    for (int axis = 0; axis < 3; ++axis)
        if (std::abs(middle[axis]) > far * extent)
            origin[axis] = std::round(middle[axis] / grid) * grid;
    return origin;
}

} // namespace ovc
