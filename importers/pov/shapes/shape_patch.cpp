// SPDX-License-Identifier: Apache-2.0
// Reads bicubic_patch, a Bezier patch of 16 points.
#include "importers/pov/shapes/shape.h"

#include <algorithm>

namespace ovc::pov {

/// Returns a point of the Bezier curve of four points and stores the derivative there in `slope`.
static dvec3 bezier(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d, double t,
                    dvec3* slope) {
    const double s = 1 - t;
    *slope = 3.0 * (s * s * (b - a) + 2 * s * t * (c - b) + t * t * (d - c));
    return s * s * s * a + 3 * s * s * t * b + 3 * s * t * t * c + t * t * t * d;
}

static Corner patch_corner(const std::array<dvec3, 16>& p, double u, double v) {
    dvec3 row[4], along[4], du, dv, ignored;
    for (size_t i = 0; i < 4; ++i)
        row[i] = bezier(p[4 * i], p[4 * i + 1], p[4 * i + 2], p[4 * i + 3], u, &along[i]);
    const dvec3 at = bezier(row[0], row[1], row[2], row[3], v, &dv);
    du = bezier(along[0], along[1], along[2], along[3], v, &ignored);
    return {at, glm::cross(du, dv)};
}

Shape parse_bicubic_patch(Reader& reader) {
    std::array<dvec2, 4> uv = {dvec2(0, 0), dvec2(1, 0), dvec2(1, 1), dvec2(0, 1)};
    for (;;) {
        if (reader.take("type") || reader.take("flatness") || reader.take("u_steps") ||
            reader.take("v_steps"))
            parse_float(reader);
        else if (reader.take("uv_vectors"))
            for (dvec2& corner : uv) {
                corner = parse_vector2(reader);
                reader.take_comma();
            }
        else if (!reader.take(','))
            break;
    }
    std::array<dvec3, 16> points;
    for (dvec3& p : points) {
        p = parse_vector(reader);
        reader.take_comma();
    }
    Shape shape;
    shape.corners_have_uv = true;
    shape.per_square = 2 / 16.0;
    shape.cut = [points, uv](int segments, bool, Facets& out) {
        const int steps = segments / 4;
        for (int j = 0; j < steps; ++j)
            for (int i = 0; i < steps; ++i) {
                const auto at = [&](int a, int b) {
                    return patch_corner(points, double(a) / steps, double(b) / steps);
                };
                const auto uv_at = [&](int a, int b) {
                    const double s = double(a) / steps, t = double(b) / steps;
                    return glm::mix(glm::mix(uv[0], uv[1], s), glm::mix(uv[3], uv[2], s), t);
                };
                out.add_quad({at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)},
                             {uv_at(i, j), uv_at(i + 1, j), uv_at(i + 1, j + 1), uv_at(i, j + 1)});
            }
    };
    return shape;
}

} // namespace ovc::pov
