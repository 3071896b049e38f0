// SPDX-License-Identifier: Apache-2.0
// A triangle cut by others: convex polygons, in a tree of cuts.
#pragma once

#include "importers/csg/mesh.h"

#include <deque>
#include <span>

namespace ovc::csg {

/// An edge lies in `plane` and in the polygon's own; the polygon is above it, or below.
struct Edge {
    const Plane* plane;
    bool below;
};

/// Convex, counterclockwise seen from above; edge i runs from point i to the next. Neighbouring
/// edges are not in line.
struct Polygon {
    std::vector<const Point*> points;
    std::vector<Edge> edges;
};

/// Points and planes stay where they are.
struct Pool {
    std::deque<Point> points;
    std::deque<Plane> planes;

    const Point* keep(Point p) { return &points.emplace_back(std::move(p)); }
    const Plane* keep(const Plane& p) { return &planes.emplace_back(p); }
};

/// A triangle and what it is cut into.
class CutTriangle {
public:
    struct Part {
        Polygon polygon;
        size_t above = 0, below = 0; // numbers of the two halves; 0: it is whole
    };

    CutTriangle(const GridTriangle& triangle, const Plane& plane, Pool& pool);

    /// Cuts what `other` touches: along it, or, where it lies in the same plane, around it.
    void cut(const GridTriangle& other, const Plane& other_plane);

    /// [0] is the whole.
    std::span<const Part> parts() const { return parts_; }
    const Plane& plane() const { return *plane_; }

private:
    void cut_across(size_t part, const Plane* by, std::span<const Plane> walls);
    void cut_around(size_t part, const GridTriangle& other, std::span<const Plane* const> walls);
    /// False where the plane does not run through the part, or only where the walls stand between.
    bool halve(size_t part, const Plane* by, std::span<const Plane> walls);

    const Plane* plane_;
    Pool& pool_;
    std::vector<Part> parts_;
};

/// A point inside a polygon of `plane`, not in the middle but where symmetry leads nothing to;
/// attempt: another one for each number.
Point inner_point(const Polygon& polygon, const Plane& plane, int attempt);

} // namespace ovc::csg
