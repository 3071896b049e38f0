// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/cut.h"

#include <cmath>

namespace ovc::csg {

namespace {

/// Returns whether a wall separates the points from the triangle: none is inside the wall, and at
/// least one is outside.
bool apart(std::span<const Point* const> points, std::span<const Plane> walls) {
    for (const Plane& wall : walls) {
        bool outside = false, inside = false;
        for (const Point* p : points) {
            const int at = side(wall, *p);
            outside = outside || at < 0;
            inside = inside || at > 0;
            if (inside)
                break;
        }
        if (outside && !inside)
            return true;
    }
    return false;
}

/// Returns the planes through the triangle's edges, parallel to the axis that it faces most. The
/// triangle is above them.
std::array<Plane, 3> walls_of(const GridTriangle& t, const Plane& plane) {
    const int axis = major_axis_of(plane);
    // Seen against the axis, the triangle runs clockwise if it is turned.
    const bool turned = plane.n[axis] < 0;
    const auto wall = [&](size_t i) {
        const GridPoint &a = t[i], &b = t[(i + 1) % 3];
        return turned ? plane_along(axis, b, a) : plane_along(axis, a, b);
    };
    return {wall(0), wall(1), wall(2)};
}

} // namespace

CutTriangle::CutTriangle(const GridTriangle& triangle, const Plane& plane, Pool& pool)
    : plane_(&plane), pool_(pool) {
    Polygon whole;
    const std::array<Plane, 3> walls = walls_of(triangle, plane);
    for (size_t i = 0; i < 3; ++i) {
        whole.points.push_back(pool.keep(point_of(triangle[i])));
        whole.edges.push_back({pool.keep(walls[i]), false});
    }
    parts_.push_back(part_of(std::move(whole)));
}

CutTriangle::Part CutTriangle::part_of(Polygon polygon) {
    Box box;
    for (const Point* p : polygon.points)
        box.add(p->near);
    return {std::move(polygon), box.padded(1)};
}

void CutTriangle::cut(const GridTriangle& other, const Plane& other_plane) {
    const std::array<Plane, 3> walls = walls_of(other, other_plane);
    int on = 0;
    for (const Point* p : parts_[0].polygon.points)
        on += side(other_plane, *p) == 0;
    if (on == 3) {
        const Plane* kept[3] = {pool_.keep(walls[0]), pool_.keep(walls[1]), pool_.keep(walls[2])};
        cut_around(0, other, kept);
    } else
        cut_across(0, box_of(other), pool_.keep(other_plane), walls);
}

void CutTriangle::cut_across(size_t part, const Box& other, const Plane* by,
                             std::span<const Plane> walls) {
    if (!parts_[part].box.touches(other) || apart(parts_[part].polygon.points, walls))
        return;
    if (parts_[part].above == 0) {
        halve(part, by, walls);
        return;
    }
    cut_across(parts_[part].above, other, by, walls);
    cut_across(parts_[part].below, other, by, walls);
}

void CutTriangle::cut_around(size_t part, const GridTriangle& other,
                             std::span<const Plane* const> walls) {
    if (!parts_[part].box.touches(box_of(other)))
        return;
    if (parts_[part].above != 0) {
        const size_t above = parts_[part].above, below = parts_[part].below;
        cut_around(above, other, walls);
        cut_around(below, other, walls);
        return;
    }
    // If two convex polygons of one plane share no inner point, an edge of one separates them.
    for (const Plane* wall : walls) {
        bool inside = false;
        for (const Point* p : parts_[part].polygon.points)
            inside = inside || side(*wall, *p) > 0;
        if (!inside)
            return;
    }
    for (const Edge& edge : parts_[part].polygon.edges) {
        bool inside = false;
        for (const GridPoint& p : other)
            inside = inside || side(*edge.plane, p) * (edge.below ? -1 : 1) > 0;
        if (!inside)
            return;
    }
    for (const Plane* wall : walls)
        if (halve(part, wall, {}))
            part = parts_[part].above;
}

bool CutTriangle::halve(size_t part, const Plane* by, std::span<const Plane> walls) {
    const Polygon polygon = parts_[part].polygon;
    const size_t count = polygon.points.size();
    std::vector<int> sides(count);
    bool above = false, below = false;
    for (size_t i = 0; i < count; ++i) {
        sides[i] = side(*by, *polygon.points[i]);
        above = above || sides[i] > 0;
        below = below || sides[i] < 0;
    }
    if (!above || !below)
        return false;
    // Each half has its points in order, and the two ends of the cut.
    Polygon halves[2]; // above, below
    std::vector<const Point*> ends;
    for (size_t i = 0; i < count; ++i) {
        const size_t next = (i + 1) % count;
        const Point* p = polygon.points[i];
        const Edge& edge = polygon.edges[i];
        for (const int half : {0, 1}) {
            const int here = half == 0 ? sides[i] : -sides[i];
            const int there = half == 0 ? sides[next] : -sides[next];
            if (here < 0)
                continue;
            halves[half].points.push_back(p);
            // An edge that leaves the half from a point on the cut is replaced by the cut.
            halves[half].edges.push_back(here == 0 && there < 0 ? Edge{by, half == 1} : edge);
        }
        if (sides[i] == 0)
            ends.push_back(p);
        if (sides[i] * sides[next] < 0) {
            const Point* crossing = pool_.keep(meet(*plane_, *edge.plane, *by));
            ends.push_back(crossing);
            for (const int half : {0, 1}) {
                const bool leaves = (half == 0 ? sides[i] : -sides[i]) > 0;
                halves[half].points.push_back(crossing);
                halves[half].edges.push_back(leaves ? Edge{by, half == 1} : edge);
            }
        }
    }
    if (!walls.empty() && apart(ends, walls))
        return false;
    for (const int half : {0, 1}) {
        (half == 0 ? parts_[part].above : parts_[part].below) = parts_.size();
        parts_.push_back(part_of(std::move(halves[half])));
    }
    return true;
}

Point inner_point(const Polygon& polygon, const Plane& plane, int attempt) {
    const size_t count = polygon.points.size();
    dvec3 sum(0);
    double weights = 0;
    for (size_t i = 0; i < count; ++i) {
        const double turn = double(i) * 0.618 + double(attempt + 1) * 0.377;
        const double weight = 0.35 + turn - std::floor(turn);
        sum += weight * polygon.points[i]->near;
        weights += weight;
    }
    const dvec3 p = sum / weights;
    // Two planes across the axes that the polygon faces less, at multiples of 2^-20, meet its plane
    // close to p.
    const int axis = major_axis_of(plane);
    const auto across = [&](int other) {
        Int128 n[3] = {0, 0, 0};
        n[other] = 1 << 20;
        return Plane(n[0], n[1], n[2], -Int128(std::ldexp(p[other], 20)));
    };
    return meet(plane, across((axis + 1) % 3), across((axis + 2) % 3));
}

} // namespace ovc::csg
