// SPDX-License-Identifier: Apache-2.0
// Corners are the positions that generators fill, three for each triangle. The functions make
// shapes that several generators use.
#pragma once

#include "core/vec.h"

#include <vector>

namespace ovc {

using Corners = std::vector<vec3>;

inline void add_triangle(Corners& out, dvec3 a, dvec3 b, dvec3 c) {
    out.insert(out.end(), {vec3(a), vec3(b), vec3(c)});
}

/// Adds a quad whose corners a, b, c, d follow each other around it.
inline void add_quad(Corners& out, dvec3 a, dvec3 b, dvec3 c, dvec3 d) {
    add_triangle(out, a, b, c);
    add_triangle(out, a, c, d);
}

/// Returns a unit vector at a right angle to the unit vector `v`.
inline dvec3 any_perpendicular(dvec3 v) {
    const dvec3 other = std::abs(v.y) < 0.9 ? dvec3(0, 1, 0) : dvec3(1, 0, 0);
    return glm::normalize(glm::cross(v, other));
}

} // namespace ovc
