// SPDX-License-Identifier: Apache-2.0
// Cuts a triangle by others into convex polygons, which form a tree of cuts.
#pragma once

#include "importers/csg/mesh.h"

#include <deque>
#include <span>

namespace ovc::csg {

/// An edge lies in `plane` and in the polygon's own plane. The polygon is above or below `plane`.
struct Edge {
    const Plane* plane;
    bool below;
};

/// A convex polygon, counterclockwise seen from above. Edge i runs from point i to the next one.
/// Neighbouring edges are not in line.
struct Polygon {
    std::vector<const Point*> points;
    std::vector<Edge> edges;
};

/// Holds points and planes, which keep their addresses.
struct Pool {
    std::deque<Point> points;
    std::deque<Plane> planes;

    const Point* keep(Point p) { return &points.emplace_back(std::move(p)); }
    const Plane* keep(const Plane& p) { return &planes.emplace_back(p); }
};

/// A triangle and the parts that it is cut into.
class CutTriangle {
public:
    struct Part {
        Polygon polygon;
        Box box;                     // around it, and a step of the grid larger
        size_t above = 0, below = 0; // the numbers of the two halves, or 0 if the part is whole
    };

    CutTriangle(const GridTriangle& triangle, const Plane& plane, Pool& pool);

    /// Cuts the parts that `other` touches along it, or around it if it lies in the same plane.
    void cut(const GridTriangle& other, const Plane& other_plane);

    /// Returns all parts. The first one is the whole triangle.
    std::span<const Part> parts() const { return parts_; }
    const Plane& plane() const { return *plane_; }

private:
    static Part part_of(Polygon polygon);
    void cut_across(size_t part, const Box& other, const Plane* by, std::span<const Plane> walls);
    void cut_around(size_t part, const GridTriangle& other, std::span<const Plane* const> walls);
    /// Cuts the part by a plane. Returns false and cuts nothing if the plane does not run through
    /// the part, or only outside the walls.
    bool halve(size_t part, const Plane* by, std::span<const Plane> walls);

    const Plane* plane_;
    Pool& pool_;
    std::vector<Part> parts_;
};

/// Returns a point inside a polygon of `plane`. The point is off the middle, because edges of
/// symmetric operands often meet there. attempt: each number gives another point.
Point inner_point(const Polygon& polygon, const Plane& plane, int attempt);

} // namespace ovc::csg
