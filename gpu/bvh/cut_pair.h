// SPDX-License-Identifier: Apache-2.0
// Cuts a pair of triangles in two by a plane across an axis, and returns the boxes of both parts.
#pragma once

#include "core/box.h"
#include "core/ray.h"
#include "gpu/bvh/pairs.h"

#include <algorithm>
#include <cmath>

namespace ovc {

struct CutPair {
    Boxf below; // empty if no point of the pair lies there, as is `above`
    Boxf above;
};

/// Returns the boxes of the pair's parts at or below `plane` and at or above it, each within `box`,
/// outside which the pair does not matter. Every point of the pair in the box is in one of the two,
/// however the corners were rounded to floats: parts are larger than they need be by four roundings
/// of the largest coordinate (docs/design/numerics.md).
inline CutPair cut_pair(const TrianglePair& pair, const Boxf& box, int axis, float plane) {
    static constexpr std::array<std::array<uint8_t, 2>, 5> kSides{
        {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {3, 2}}};
    const size_t sides = pair.b == kNone ? 3 : 5;
    CutPair cut;
    float largest = 0;
    for (const vec3& corner : pair.corners) {
        if (corner[axis] <= plane)
            cut.below.add(corner);
        if (corner[axis] >= plane)
            cut.above.add(corner);
        largest = std::max({largest, std::abs(corner.x), std::abs(corner.y), std::abs(corner.z)});
    }
    for (size_t i = 0; i < sides; ++i) {
        const vec3& from = pair.corners[kSides[i][0]];
        const vec3& to = pair.corners[kSides[i][1]];
        if (!(from[axis] < plane && to[axis] > plane) && !(from[axis] > plane && to[axis] < plane))
            continue;
        const double share =
            (double(plane) - double(from[axis])) / (double(to[axis]) - double(from[axis]));
        vec3 crossing(dvec3(from) + share * (dvec3(to) - dvec3(from)));
        crossing[axis] = plane;
        cut.below.add(crossing);
        cut.above.add(crossing);
    }
    const float margin = 0x1p-22f * largest;
    for (Boxf* part : {&cut.below, &cut.above})
        if (!part->empty())
            // Clamped, not intersected: a part within a rounding of the box must not come out
            // empty.
            *part = {glm::clamp(part->lo - margin, box.lo, box.hi),
                     glm::clamp(part->hi + margin, box.lo, box.hi)};
    return cut;
}

} // namespace ovc
