// SPDX-License-Identifier: Apache-2.0
// Corners: what generators fill, three positions a triangle; and the few shapes that several of
// them use.
#pragma once

#include "core/vec.h"

#include <vector>

namespace ovc {

using Corners = std::vector<vec3>;

inline void add_triangle(Corners& out, dvec3 a, dvec3 b, dvec3 c) {
    out.insert(out.end(), {vec3(a), vec3(b), vec3(c)});
}

/// a, b, c, d in turn round the quad.
inline void add_quad(Corners& out, dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    add_triangle(out, a, b, c);
    add_triangle(out, a, c, d);
}

/// Some unit vector at a right angle to the unit vector `v`.
inline dvec3 any_perpendicular(dvec3 v) {
    const dvec3 other = std::abs(v.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    return glm::normalize(glm::cross(v, other));
}

} // namespace ovc
