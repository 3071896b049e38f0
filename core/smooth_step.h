// SPDX-License-Identifier: Apache-2.0
// A smooth transition from 0 to 1.
#pragma once

#include <algorithm>

namespace ovc {

/// Returns 3 t^2 - 2 t^3, which is flat at 0 and at 1. t: from 0 to 1.
inline double smooth_step(double t) {
    return t * t * (3 - 2 * t);
}

/// Returns 0 up to `from`, 1 from `to` on, and a smooth transition between. If from > to, it is the
/// other way round.
inline double smooth_step(double from, double to, double x) {
    return smooth_step(std::clamp((x - from) / (to - from), 0.0, 1.0));
}

} // namespace ovc
