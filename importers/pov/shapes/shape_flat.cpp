// SPDX-License-Identifier: Apache-2.0
// Reads shapes that are flat or have flat sides only, which need no segments.
#include "importers/pov/shapes/contour.h"
#include "importers/pov/shapes/shape.h"
#include "importers/pov/shapes/simple_contours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

namespace ovc::pov {

namespace {

/// Returns a shape with the same triangles however finely others are cut.
Shape fixed(Facets facets) {
    Shape shape;
    shape.fixed = double(facets.corners.size() / 3);
    shape.cut = [facets = std::move(facets)](int, bool, Facets& out) {
        out.corners.insert(out.corners.end(), facets.corners.begin(), facets.corners.end());
        out.smooth = out.smooth || facets.smooth;
    };
    return shape;
}

/// Splits a polygon's points into parts. Each ends where it returns to the point it began with.
std::vector<std::vector<dvec3>> parts_of(const std::vector<dvec3>& points) {
    std::vector<std::vector<dvec3>> parts;
    for (size_t first = 0; first < points.size();) {
        size_t last = first + 1;
        while (last < points.size() && glm::length(points[last] - points[first]) > 1e-10)
            ++last;
        if (last - first >= 3)
            parts.emplace_back(points.begin() + ptrdiff_t(first), points.begin() + ptrdiff_t(last));
        first = last + 1;
    }
    return parts;
}

/// Returns Newell's normal of a polygon.
dvec3 normal_of(const std::vector<dvec3>& points) {
    assert(points.size() >= 3);
    dvec3 n(0);
    for (size_t i = 0, j = points.size() - 1; i < points.size(); j = i++)
        n += glm::cross(points[j] - points[0], points[i] - points[0]);
    return n;
}

} // namespace

Shape parse_box(Reader& reader) {
    const dvec3 one = parse_vector(reader);
    reader.take_comma();
    const dvec3 two = parse_vector(reader);
    const dvec3 lo = glm::min(one, two), hi = glm::max(one, two);
    Facets facets;
    for (int axis = 0; axis < 3; ++axis)
        for (int side = 0; side < 2; ++side) {
            const int b = (axis + (side ? 1 : 2)) % 3, c = (axis + (side ? 2 : 1)) % 3;
            dvec3 corners[4];
            for (int i = 0; i < 4; ++i) {
                corners[i][axis] = side ? hi[axis] : lo[axis];
                corners[i][b] = i == 1 || i == 2 ? hi[b] : lo[b];
                corners[i][c] = i >= 2 ? hi[c] : lo[c];
            }
            facets.add_quad(corners[0], corners[1], corners[2], corners[3]);
        }
    Shape shape = fixed(std::move(facets));
    TextureStep to_unit;
    for (int axis = 0; axis < 3; ++axis) {
        const double half = std::max(0.5 * (hi[axis] - lo[axis]), 1e-300);
        to_unit.rows[size_t(axis)] /= half;
        to_unit.rows[size_t(axis)].w = -0.5 * (lo[axis] + hi[axis]) / half;
    }
    shape.to_uv = {to_unit, {TextureStep::Kind::BoxNet}};
    return shape;
}

Shape parse_triangle(Reader& reader) {
    dvec3 p[3];
    for (dvec3& corner : p) {
        corner = parse_vector(reader);
        reader.take_comma();
    }
    Facets facets;
    facets.add(p[0], p[1], p[2]);
    return fixed(std::move(facets));
}

Shape parse_smooth_triangle(Reader& reader) {
    Corner c[3];
    for (Corner& corner : c) {
        corner.position = parse_vector(reader);
        reader.take_comma();
        corner.normal = parse_vector(reader);
        reader.take_comma();
    }
    Facets facets;
    facets.add(c[0], c[1], c[2]);
    return fixed(std::move(facets));
}

Shape parse_polygon(Reader& reader) {
    const int count = parse_count(reader, 3);
    reader.take_comma();
    std::vector<dvec3> points;
    for (int i = 0; i < count; ++i) {
        points.push_back(parse_vector(reader));
        reader.take_comma();
    }
    const std::vector<std::vector<dvec3>> parts = parts_of(points);
    Facets facets;
    if (parts.empty())
        return fixed(std::move(facets));
    // The polygon is projected along the axis that its plane faces most.
    const dvec3 normal = normal_of(parts[0]);
    const int axis = major_axis(normal);
    const int x = (axis + 1) % 3, y = (axis + 2) % 3;
    std::vector<Contour> contours;
    std::map<std::pair<double, double>, dvec3> corners;
    for (const auto& part : parts) {
        contours.emplace_back();
        for (const dvec3& p : part) {
            contours.back().push_back({p[x], p[y]});
            corners[{p[x], p[y]}] = p;
        }
    }
    contours = simple_contours(std::move(contours));
    std::vector<dvec3> all;
    for (const Contour& contour : contours)
        for (const dvec2& p : contour) {
            const auto corner = corners.find({p.x, p.y});
            if (corner != corners.end()) {
                all.push_back(corner->second);
                continue;
            }
            dvec3 crossing = parts[0][0]; // where edges cross, in the polygon's plane
            crossing[axis] -=
                (normal[x] * (p.x - crossing[x]) + normal[y] * (p.y - crossing[y])) / normal[axis];
            crossing[x] = p.x;
            crossing[y] = p.y;
            all.push_back(crossing);
        }
    for (const auto& t : cut_contours(contours))
        facets.add(all[t[0]], all[t[1]], all[t[2]]);
    return fixed(std::move(facets));
}

} // namespace ovc::pov
