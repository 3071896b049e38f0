// SPDX-License-Identifier: Apache-2.0
// Operands on the grid, made ready for questions.
#pragma once

#include "importers/csg/box_tree.h"
#include "importers/csg/csg.h"
#include "importers/csg/exact.h"

namespace ovc::csg {

using GridTriangle = std::array<GridPoint, 3>;

/// From doubles to the grid and back: a power of two, about the middle of all operands.
struct Grid {
    dvec3 origin{0};
    int exponent = 0; // a step of the grid is 2^exponent

    explicit Grid(const std::vector<Operand>& operands);
    bool holds(const dvec3& p) const;
    GridPoint to_grid(const dvec3& p) const;
    dvec3 from_grid(const std::array<int64_t, 3>& rounded) const;
};

struct Mesh {
    std::vector<GridTriangle> triangles;
    std::vector<Plane> planes; // null: no triangle
    std::vector<uint8_t> hidden;
    BoxTree boxes;
    bool solid, inverse;

    Mesh(const Operand& operand, const Grid& grid);
};

Box box_of(const GridTriangle& triangle);

/// What is inside a mesh just above a point and just below it. The two differ where the point is on
/// the mesh.
struct Sides {
    bool above = false, below = false;
};

/// point lies on `from`, away from the edges of triangles that are not in its plane; above is where
/// the normal of `from` points.
Sides sides_of(const Mesh& mesh, const Point& point, const Plane& from);

} // namespace ovc::csg
