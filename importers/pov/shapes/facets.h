// SPDX-License-Identifier: Apache-2.0
// Facets: the triangles that a shape is cut into, with a normal at each corner.
#pragma once

#include "core/vec.h"

#include <array>
#include <vector>

namespace ovc::pov {

struct Corner {
    dvec3 position;
    dvec3 normal; // of any length; 0 stands for the triangle's normal
};

/// Triangles of three corners each, counterclockwise seen from outside. Normals point outside.
struct Facets {
    std::vector<Corner> corners;
    std::vector<vec2> uv;     // texture coordinates of the corners, or empty
    bool smooth = false;      // whether some corner has a normal of its own
    double circle_radius = 1; // CirclePieces::radius of what is added

    /// Adds a flat triangle, unless two of its corners are the same, as at a pole or a seam.
    /// Returns whether it was added.
    bool add(const dvec3& a, const dvec3& b, const dvec3& c) {
        if (a == b || b == c || c == a)
            return false;
        for (const dvec3& p : {a, b, c})
            corners.push_back({p, dvec3(0)});
        return true;
    }
    bool add(const Corner& a, const Corner& b, const Corner& c) {
        if (a.position == b.position || b.position == c.position || c.position == a.position)
            return false;
        corners.insert(corners.end(), {a, b, c});
        smooth = true;
        return true;
    }
    /// Adds a triangle with texture coordinates, which then all triangles must have.
    bool add(const std::array<Corner, 3>& c, const std::array<dvec2, 3>& at) {
        const bool added = add(c[0], c[1], c[2]);
        for (size_t i = 0; added && i < 3; ++i)
            uv.emplace_back(at[i]);
        return added;
    }
    void clear() {
        corners.clear();
        uv.clear();
        smooth = false;
    }
    void add_quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        add(a, b, c);
        add(a, c, d);
    }
    void add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
        add(a, b, c);
        add(a, c, d);
    }
    void add_quad(const std::array<Corner, 4>& c, const std::array<dvec2, 4>& at) {
        add({c[0], c[1], c[2]}, {at[0], at[1], at[2]});
        add({c[0], c[2], c[3]}, {at[0], at[2], at[3]});
    }
};

/// Returns the point of the unit circle that is `step` of `segments` steps from (1, 0). It is exact
/// on the axes, and the same for steps a whole turn apart. step: from 0; segments: a multiple of 4.
dvec2 on_circle(int step, int segments);

/// The polygon that stands for a circle.
struct CirclePieces {
    int segments;      // of a circle; a multiple of 4, at least 8
    double radius = 1; // of the polygon's corners, in the circle's: 1 for corners on it
};

/// Returns pieces whose polygon has the circle's area. Outlines of round shapes then lie as far
/// outside of the true ones as inside, and off by a third of what corners on the circle make of it.
CirclePieces as_large_as_circles(int segments);

} // namespace ovc::pov
