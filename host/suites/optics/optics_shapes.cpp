// SPDX-License-Identifier: Apache-2.0
// Makes the shapes of the optics table.
#include "host/suites/optics/optics_shapes.h"

#include "testscenes/corners.h"
#include "testscenes/random.h"
#include "testscenes/sphere.h"

#include <numbers>
#include <string>

namespace ovc {

namespace {

using Points = std::vector<dvec3>; // three for each triangle

/// Returns a turned copy with axes of these lengths.
Points stretched(Points points, dvec3 lengths, Random& random) {
    const dvec3 x = random.direction(), y = any_perpendicular(x), z = glm::cross(x, y);
    for (dvec3& p : points)
        p = lengths.x * p.x * x + lengths.y * p.y * y + lengths.z * p.z * z;
    return points;
}

Points tetrahedron() {
    const dvec3 a(1, 1, 1), b(1, -1, -1), c(-1, 1, -1), d(-1, -1, 1);
    Points points{a, b, c, a, c, d, a, d, b, b, d, c};
    for (dvec3& p : points)
        p /= std::sqrt(3.0);
    return points;
}

Points ball(uint32_t level) {
    Points points;
    for (const vec3& corner : make_sphere(level))
        points.emplace_back(corner);
    return points;
}

Points cube() {
    Points points;
    const auto at = [](int axis, double depth, double x, double y) {
        dvec3 p;
        p[axis] = depth;
        p[(axis + 1) % 3] = x;
        p[(axis + 2) % 3] = y;
        return p / std::sqrt(3.0);
    };
    for (int axis = 0; axis < 3; ++axis)
        for (const double depth : {-1.0, 1.0}) {
            const dvec3 a = at(axis, depth, -1, -1), b = at(axis, depth, depth, -depth);
            const dvec3 c = at(axis, depth, 1, 1), d = at(axis, depth, -depth, depth);
            points.insert(points.end(), {a, b, c, a, c, d});
        }
    return points;
}

Points lat_long_of(Random& random) {
    constexpr int rows = 6, columns = 8;
    Points grid;
    for (int r = 0; r <= rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const double polar = std::numbers::pi * r / rows,
                         around = 2 * std::numbers::pi * c / columns;
            const dvec3 out(std::sin(polar) * std::cos(around), std::sin(polar) * std::sin(around),
                            std::cos(polar));
            const bool pole = r == 0 || r == rows;
            grid.push_back(pole ? dvec3(0, 0, r == 0 ? 1 : -1) : random.uniform(0.5, 1.5) * out);
        }
    Points points;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const auto at = [&](int row, int column) {
                return grid[size_t(row * columns + column % columns)];
            };
            if (r > 0)
                points.insert(points.end(), {at(r, c), at(r + 1, c), at(r, c + 1)});
            if (r < rows - 1)
                points.insert(points.end(), {at(r + 1, c), at(r + 1, c + 1), at(r, c + 1)});
        }
    return points;
}

struct Shape {
    Points points;
    bool convex;
};

Shape make_shape(uint32_t i, Random& random) {
    const dvec3 blunt{random.uniform(0.3, 1), random.uniform(0.3, 1), random.uniform(0.3, 1)};
    const double thin = std::pow(10.0, random.uniform(-4, -1));
    switch (i % 6) {
    case 0:
        return {stretched(tetrahedron(), blunt, random), true};
    case 1:
        return {stretched(ball(2), blunt, random), true};
    case 2:
        return {lat_long_of(random), false};
    case 3: // not convex, since the halves of a side, rounded to float, need not lie in one plane
        return {stretched(cube(), blunt, random), false};
    case 4:
        return {stretched(cube(), {1, blunt.y, thin}, random), false};
    default:
        return {stretched(tetrahedron(), {1, thin, thin}, random), true};
    }
}

/// Returns for each corner a random normal on the outer side of the corner's own triangle.
std::vector<vec3> wild_normals(const Corners& corners, Random& random) {
    std::vector<vec3> normals;
    for (size_t i = 0; i < corners.size(); ++i) {
        const dvec3 a(corners[i / 3 * 3]), b(corners[i / 3 * 3 + 1]), c(corners[i / 3 * 3 + 2]);
        const dvec3 wild = random.direction();
        normals.emplace_back(glm::dot(wild, glm::cross(b - a, c - a)) < 0 ? -wild : wild);
    }
    return normals;
}

} // namespace

ShapeField make_shape_field(uint32_t count, double scale) {
    ShapeField field;
    field.scale = scale;
    for (const double ior : {1 + 1e-12, 1 - 1e-12, 1.5, 1 / 1.5, 1e3})
        field.scene.materials.push_back({"glass", vec3(0), 0.5f, 0.5f, vec3(1), ior});
    for (uint32_t i = 0; i < count; ++i) {
        Random random(/* seed= */ 1980, i);
        Shape shape = make_shape(i, random);
        Corners corners;
        for (const dvec3& p : shape.points)
            corners.emplace_back(scale * p);
        const dvec3 origin = 4 * scale * (dvec3(i % 10, i / 10 % 10, i / 100) - 4.5);
        std::vector<vec3> normals;
        if (i / 6 % 2 == 1)
            normals = wild_normals(corners, random);
        field.scene.add_mesh("shape", i % 5, Chunk::owning(origin, std::move(corners)),
                             std::move(normals));
        field.convex.push_back(shape.convex);
    }
    return field;
}

} // namespace ovc
