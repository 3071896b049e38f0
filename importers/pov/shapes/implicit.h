// SPDX-License-Identifier: Apache-2.0
// Implicit surfaces: where a field is 0, made triangles.
// Source: Gibson 1998, "Constrained Elastic Surface Nets"; here vertices are moved onto the
// surface along the field's gradient.
#pragma once

#include "core/box.h"
#include "importers/pov/shapes/facets.h"

#include <functional>

namespace ovc::pov {

/// Below 0 inside.
struct Field {
    std::function<double(const dvec3&)> value;
    /// The same field where it is asked for in this box only, cheaper; empty: value itself.
    std::function<std::function<double(const dvec3&)>(const Box&)> within;
};

/// Cells along the longest side of a closed shape that are as fine as a sphere's segments.
inline int field_cells(int segments) {
    return segments * 2 / 3;
}

/// The field's surface in a box of `cells` cells along its longest side, and some way out of it,
/// where it is closed. Corners lie on the surface and have its normals. Returns the number of
/// triangles that are of the surface: those behind close it, all of them outside of the box.
/// What is thinner than a cell may be lost.
size_t cut_field(const Field& field, const Box& box, int cells, Facets& out);

} // namespace ovc::pov
