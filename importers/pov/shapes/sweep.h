// SPDX-License-Identifier: Apache-2.0
// Sweeps contours along a path, for prisms and letters.
#pragma once

#include "importers/pov/shapes/contour.h"
#include "importers/pov/shapes/facets.h"

#include <cassert>

namespace ovc::pov {

/// Adds the sides between contours and their copies, and with `lids` both ends, to `out`. With lids
/// the surface is closed, and it faces outside. place(point, false) and place(point, true) give a
/// point's position at the beginning and at the end of the sweep, which goes against the cross
/// product of the plane's first axis with its second. contours: each of at least 3 points; they do
/// not cross.
template <class Placing>
void sweep(const std::vector<Contour>& contours, bool lids, Placing place, Facets& out) {
    std::vector<dvec2> all;
    for (const Contour& c : contours) {
        assert(c.size() >= 3);
        all.insert(all.end(), c.begin(), c.end());
        // Outside is to the right of a counterclockwise curve, but to the left where it is a hole.
        const bool forwards = (doubled_area(c) > 0) == (depth_of(c, contours) % 2 == 0);
        for (size_t i = 0; i < c.size(); ++i) {
            const dvec2& p = c[forwards ? i : (i + 1) % c.size()];
            const dvec2& q = c[forwards ? (i + 1) % c.size() : i];
            out.add_quad(place(p, false), place(p, true), place(q, true), place(q, false));
        }
    }
    if (!lids)
        return;
    for (const auto& t : cut_contours(contours)) {
        out.add(place(all[t[2]], true), place(all[t[1]], true), place(all[t[0]], true));
        out.add(place(all[t[0]], false), place(all[t[1]], false), place(all[t[2]], false));
    }
}

} // namespace ovc::pov
