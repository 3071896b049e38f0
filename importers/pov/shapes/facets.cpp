// SPDX-License-Identifier: Apache-2.0
#include "importers/pov/shapes/facets.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

namespace ovc::pov {

dvec2 on_circle(int step, int segments) {
    assert(step >= 0 && segments >= 4 && segments % 4 == 0);
    step %= segments;
    // Only the first eighth is computed and the rest mirrored, so that opposite points have the
    // same coordinates, and those on the axes are exact.
    const int quarter = segments / 4;
    const int turns = step / quarter, rest = step % quarter;
    const auto first_quarter = [&](int s) -> dvec2 {
        if (2 * s == quarter)
            return dvec2(std::sqrt(0.5));
        const double angle = 2 * std::numbers::pi * std::min(s, quarter - s) / segments;
        const dvec2 p(std::cos(angle), std::sin(angle));
        return 2 * s < quarter ? p : dvec2(p.y, p.x);
    };
    const dvec2 p = first_quarter(rest);
    switch (turns) {
    case 0:
        return p;
    case 1:
        return {-p.y, p.x};
    case 2:
        return -p;
    default:
        return {p.y, -p.x};
    }
}

CirclePieces as_large_as_circles(int segments) {
    const double step = 2 * std::numbers::pi / segments;
    return {segments, std::sqrt(step / std::sin(step))};
}

} // namespace ovc::pov
