// SPDX-License-Identifier: Apache-2.0
#include "importers/csg/mesh.h"

#include <cmath>

namespace ovc::csg {

Grid::Grid(const std::vector<Operand>& operands) {
    Box box;
    for (const Operand& operand : operands)
        for (const auto& triangle : operand.triangles)
            for (const dvec3& corner : triangle)
                if (is_finite(corner))
                    box.add(corner);
    if (box.empty() || !is_finite(box.extent()))
        return;
    const dvec3 half = 0.5 * box.extent();
    std::frexp(std::max(max_component(half), 1e-30), &exponent);
    exponent += 2 - kGridBits; // One of the two bits makes room for the rounding of the origin.
    // The origin is a multiple of the grid's step, so that integers stay integers; where snapping
    // moves corners by more than textures can overlook, also one of what corners are snapped to.
    constexpr double kSmall = 1024;
    const int snapped = exponent + (max_component(half) > kSmall ? kSnapBits : 0);
    for (int i = 0; i < 3; ++i)
        origin[i] = std::ldexp(std::round(std::ldexp(box.center()[i], -snapped)), snapped);
}

bool Grid::holds(const dvec3& p) const {
    return is_finite(p) &&
           max_component(glm::abs(p - origin)) <= std::ldexp(1, exponent + kGridBits);
}

GridPoint Grid::to_grid(const dvec3& p) const {
    GridPoint at;
    for (size_t i = 0; i < 3; ++i)
        at[i] = std::llround(std::ldexp(p[int(i)] - origin[int(i)], -exponent));
    return at;
}

dvec3 Grid::from_grid(const std::array<int64_t, 3>& rounded) const {
    dvec3 p;
    for (size_t i = 0; i < 3; ++i)
        p[int(i)] = origin[int(i)] + std::ldexp(double(rounded[i]), exponent - kFractionBits);
    return p;
}

Box box_of(const GridTriangle& triangle) {
    Box box;
    for (const GridPoint& p : triangle)
        box.add(dvec3(double(p[0]), double(p[1]), double(p[2])));
    return box;
}

Mesh::Mesh(const Operand& operand, const Grid& grid)
    : hidden(operand.hidden), solid(operand.solid), inverse(operand.inverse) {
    std::vector<Box> all;
    for (const auto& corners : operand.triangles) {
        GridTriangle triangle{};
        if (grid.holds(corners[0]) && grid.holds(corners[1]) && grid.holds(corners[2]))
            for (size_t i = 0; i < 3; ++i)
                triangle[i] = grid.to_grid(corners[i]);
        triangles.push_back(triangle);
        planes.push_back(plane_through(triangle[0], triangle[1], triangle[2]));
        all.push_back(box_of(triangle));
    }
    boxes = BoxTree(all);
}

namespace {

/// Returns the side of a vertical plane that a point is on after an infinitesimal step (e, e^2)
/// along the two axes that follow `axis`. The step makes sure that no point lies above an edge.
int moved_side(const Plane& vertical, const Point& p, int axis) {
    const int at = side(vertical, p);
    if (at != 0)
        return at;
    for (int i = 1; i < 3; ++i)
        if (const Int128& n = vertical.n[(axis + i) % 3]; n != 0)
            return n > 0 ? 1 : -1;
    return 0;
}

bool is_over(const GridTriangle& t, const Point& p, int axis) {
    int sum = 0;
    for (size_t i = 0; i < 3; ++i)
        sum += moved_side(plane_along(axis, t[i], t[(i + 1) % 3]), p, axis);
    return std::abs(sum) == 3;
}

} // namespace

// Sends a ray from the point along the axis that `from` faces most, and counts the triangles that
// it crosses (up). A triangle that the point lies on parts the two sides (through).
Sides sides_of(const Mesh& mesh, const Point& point, const Plane& from) {
    if (!mesh.solid)
        return {};
    const int axis = major_axis_of(from);
    Box ray{point.near - 1.0, point.near + 1.0};
    ray.hi[axis] = std::numeric_limits<double>::infinity();
    bool up = false, through = false;
    mesh.boxes.visit(ray, [&](uint32_t t) {
        const Plane& plane = mesh.planes[t];
        if (plane.n[axis] == 0 || !is_over(mesh.triangles[t], point, axis))
            return;
        const int at = side(plane, point) * (plane.n[axis] > 0 ? 1 : -1); // 1: above the triangle
        up ^= at < 0;
        through ^= at == 0;
    });
    const bool down = up != through;
    const Sides sides = from.n[axis] > 0 ? Sides{up, down} : Sides{down, up};
    return mesh.inverse ? Sides{!sides.above, !sides.below} : sides;
}

} // namespace ovc::csg
