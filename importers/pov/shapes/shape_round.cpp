// SPDX-License-Identifier: Apache-2.0
// Reads surfaces of revolution and superellipsoids. Vertices lie on the true surface.
#include "importers/pov/shapes/shape.h"

#include <fmt/format.h>

#include <cmath>

namespace ovc::pov {

namespace {

/// Adds a grid of quads whose last column meets its first. at(column, row) gives a corner. Seen
/// from outside the first row is the lowest; seen from above columns run counterclockwise.
template <class At>
void add_grid(int columns, int rows, At&& at, Facets& out) {
    if (out.corners.empty())
        out.corners.reserve(6 * size_t(columns) * size_t(rows));
    std::vector<Corner> below, above;
    for (int row = 0; row <= rows; ++row) {
        above.clear();
        for (int column = 0; column < columns; ++column)
            above.push_back(at(column, row));
        for (int column = 0; row > 0 && column < columns; ++column) {
            const size_t a = size_t(column), b = size_t((column + 1) % columns);
            out.add_quad(below[a], below[b], above[b], above[a]);
        }
        std::swap(below, above);
    }
}

Shape curved(double per_square, double per_segment, SharedFunction<void(int, bool, Facets&)> cut,
             bool of_circles = true) {
    Shape shape;
    shape.of_circles = of_circles;
    shape.cut = std::move(cut);
    shape.per_square = per_square;
    shape.per_segment = per_segment;
    return shape;
}

/// Sets u and v to unit vectors perpendicular to `axis`, with u x v along it. They are axes of the
/// world where `axis` is one.
void across(const dvec3& axis, dvec3& u, dvec3& v) {
    const int major = major_axis(axis);
    dvec3 other(0);
    other[(major + 1) % 3] = 1;
    u = glm::normalize(other - glm::dot(other, axis) / glm::dot(axis, axis) * axis);
    v = glm::normalize(glm::cross(axis, u));
}

Shape frustum(Reader& reader, const dvec3& base, double base_radius, const dvec3& cap,
              double cap_radius) {
    const dvec3 axis = cap - base;
    if (!(glm::length(axis) > 0))
        reader.fail(reader.place(), "found a cone or cylinder whose ends are one point");
    Shape shape = curved(0, 4, [=](int segments, bool open, Facets& out) {
        dvec3 u, v;
        across(axis, u, v);
        const double slant = (base_radius - cap_radius) / glm::dot(axis, axis);
        const double base_reach = out.circle_radius * base_radius;
        const double cap_reach = out.circle_radius * cap_radius;
        const auto corner = [&](int column, int row) -> Corner {
            const dvec2 p = on_circle(column, segments);
            const dvec3 outward = p.x * u + p.y * v;
            return {row ? cap + cap_reach * outward : base + base_reach * outward,
                    outward + slant * axis};
        };
        add_grid(segments, 1, corner, out);
        for (int i = 1; !open && i + 1 < segments; ++i) {
            const auto at = [&](int column, int row) { return corner(column, row).position; };
            out.add(at(0, 1), at(i, 1), at(i + 1, 1));
            out.add(at(0, 0), at(i + 1, 0), at(i, 0));
        }
    });
    shape.exact = RoundShape{base, base_radius, cap, cap_radius, /* is_ball= */ false};
    return shape;
}

double signed_power(double base, double exponent) {
    return std::copysign(std::pow(std::abs(base), exponent), base);
}

} // namespace

int parse_count(Reader& reader, int min) {
    return parse_int(reader, min, 10'000'000, "the number of points");
}

Shape parse_sphere(Reader& reader) {
    const dvec3 center = parse_vector(reader);
    reader.take_comma();
    const double radius = std::abs(parse_float(reader));
    Shape shape = curved(1, 0, [=](int segments, bool, Facets& out) {
        add_grid(
            segments, segments / 2,
            [&](int column, int row) -> Corner {
                const dvec2 around = on_circle(column, segments);
                const dvec2 up = on_circle(row + 3 * segments / 4, segments);
                const dvec3 n(up.x * around.x, up.y, -up.x * around.y);
                return {center + out.circle_radius * radius * n, n};
            },
            out);
    });
    shape.exact = RoundShape{center, radius};
    TextureStep to_center;
    for (int i = 0; i < 3; ++i)
        to_center.rows[size_t(i)].w = -center[i];
    shape.to_uv = {to_center, wrapped_around_y(TextureStep::Kind::Spherical)};
    return shape;
}

Shape parse_cylinder(Reader& reader) {
    const dvec3 base = parse_vector(reader);
    reader.take_comma();
    const dvec3 cap = parse_vector(reader);
    reader.take_comma();
    const double radius = std::abs(parse_float(reader));
    return frustum(reader, base, radius, cap, radius);
}

Shape parse_cone(Reader& reader) {
    const dvec3 base = parse_vector(reader);
    reader.take_comma();
    const double base_radius = std::abs(parse_float(reader));
    reader.take_comma();
    const dvec3 cap = parse_vector(reader);
    reader.take_comma();
    return frustum(reader, base, base_radius, cap, std::abs(parse_float(reader)));
}

Shape parse_torus(Reader& reader) {
    const double major = parse_float(reader);
    reader.take_comma();
    const double minor = std::abs(parse_float(reader));
    Shape shape = curved(2, 0, [=](int segments, bool, Facets& out) {
        add_grid(
            segments, segments,
            [&](int column, int row) -> Corner {
                const dvec2 around = on_circle(column, segments);
                const dvec2 tube = on_circle(row, segments);
                const dvec3 outward(around.x, 0, -around.y);
                const dvec3 n = tube.x * outward + dvec3(0, tube.y, 0);
                return {out.circle_radius * (major * outward + minor * n), n};
            },
            out);
    });
    TextureStep mirrored; // POV-Ray's tori begin at -x
    mirrored.rows[0].x = -1;
    shape.to_uv = {mirrored, wrapped_around_y(TextureStep::Kind::Toroidal, major)};
    return shape;
}

Shape parse_disc(Reader& reader) {
    const dvec3 center = parse_vector(reader);
    reader.take_comma();
    const dvec3 normal = parse_vector(reader);
    reader.take_comma();
    const double radius = std::abs(parse_float(reader));
    const double hole = reader.take(',') ? std::abs(parse_float(reader)) : 0;
    if (!(glm::length(normal) > 0))
        reader.fail(reader.place(), "found a disc whose normal is 0");
    return curved(0, 2, [=](int segments, bool, Facets& out) {
        dvec3 u, v;
        across(normal, u, v);
        for (int i = 0; i < segments; ++i) {
            const dvec2 p = on_circle(i, segments), q = on_circle(i + 1, segments);
            const dvec3 a = out.circle_radius * (p.x * u + p.y * v);
            const dvec3 b = out.circle_radius * (q.x * u + q.y * v);
            out.add_quad(center + hole * a, center + radius * a, center + radius * b,
                         center + hole * b);
        }
    });
}

Shape parse_superellipsoid(Reader& reader) {
    const dvec2 given = parse_vector2(reader);
    if (!(given.x >= 0 && given.y >= 0))
        reader.fail(reader.place(), "found a superellipsoid whose exponents are below 0");
    const dvec2 exponents = glm::max(given, 1e-3); // as povray draws those that are less
    return curved(
        1, 0,
        [=](int segments, bool, Facets& out) {
            const double east = exponents.x, north = exponents.y;
            add_grid(
                segments, segments / 2,
                [&](int column, int row) -> Corner {
                    const dvec2 around = on_circle(column, segments);
                    const dvec2 up = on_circle(row + 3 * segments / 4, segments);
                    const auto point = [&](double e, double n) {
                        const double wide = signed_power(up.x, n);
                        return dvec3(wide * signed_power(around.x, e),
                                     wide * signed_power(around.y, e), signed_power(up.y, n));
                    };
                    // With an exponent of 2 or more the gradient is infinite, or undefined, at a
                    // ridge.
                    const bool ridged = east >= 2 || north >= 2;
                    return {point(east, north), ridged ? dvec3(0) : point(2 - east, 2 - north)};
                },
                out);
        },
        /* of_circles= */ false);
}

} // namespace ovc::pov
