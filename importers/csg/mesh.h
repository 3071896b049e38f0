// SPDX-License-Identifier: Apache-2.0
// Operands on the grid, with planes and a tree of boxes.
#pragma once

#include "importers/csg/box_tree.h"
#include "importers/csg/csg.h"
#include "importers/csg/exact.h"

namespace ovc::csg {

using GridTriangle = std::array<GridPoint, 3>;

/// Converts between doubles and the grid, whose origin is the middle of all operands.
struct Grid {
    dvec3 origin{0};
    int exponent = 0; // A step of the grid is 2^exponent.

    explicit Grid(const std::vector<Operand>& operands);
    bool holds(const dvec3& p) const;
    GridPoint to_grid(const dvec3& p) const;
    dvec3 from_grid(const std::array<int64_t, 3>& rounded) const;
};

struct Mesh {
    std::vector<GridTriangle> triangles;
    std::vector<Plane> planes; // A triangle without a plane (is_null) is left out.
    std::vector<uint8_t> hidden;
    BoxTree boxes;
    bool solid, inverse;

    Mesh(const Operand& operand, const Grid& grid);
};

Box box_of(const GridTriangle& triangle);

/// Says whether the places just above and just below a point are inside a mesh. The two differ if
/// the point is on the mesh.
struct Sides {
    bool above = false, below = false;
};

/// Returns the sides of `point`, which lies on `from`, but not on an edge of a triangle of the mesh
/// that is not in this plane. The normal of `from` points above.
Sides sides_of(const Mesh& mesh, const Point& point, const Plane& from);

} // namespace ovc::csg
