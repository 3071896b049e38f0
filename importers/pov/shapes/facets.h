// SPDX-License-Identifier: Apache-2.0
// Facets: what shapes are cut into: triangles with a normal at each corner.
#pragma once

#include "core/vec.h"

#include <vector>

namespace ovc::pov {

struct Corner {
    dvec3 position;
    dvec3 normal; // of any length; 0: the triangle's own
};

/// Corners counterclockwise seen from outside, three a triangle; normals point outside.
struct Facets {
    std::vector<Corner> corners;
    bool smooth = false; // some corner has a normal of its own

    /// Flat. A triangle without area is left out, as a pole's or a seam's is.
    void add(const dvec3& a, const dvec3& b, const dvec3& c) {
        if (a != b && b != c && c != a)
            for (const dvec3& p : {a, b, c})
                corners.push_back({p, dvec3(0)});
    }
    void add(const Corner& a, const Corner& b, const Corner& c) {
        if (a.position == b.position || b.position == c.position || c.position == a.position)
            return;
        corners.insert(corners.end(), {a, b, c});
        smooth = true;
    }
    void add_quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
        add(a, b, c);
        add(a, c, d);
    }
    void add_quad(const Corner& a, const Corner& b, const Corner& c, const Corner& d) {
        add(a, b, c);
        add(a, c, d);
    }
};

/// The point of the unit circle `step` of `segments` steps from (1, 0) on; exact on the axes, and
/// the same for steps a whole turn apart.
dvec2 on_circle(int step, int segments);

} // namespace ovc::pov
