// SPDX-License-Identifier: Apache-2.0
// Reads parametric: the surface of the points that three functions of u and v give, as far as it
// lies in a container.
#include "importers/pov/shapes/shape.h"
#include "importers/pov/values/function.h"

#include <algorithm>
#include <cmath>

namespace ovc::pov {

namespace {

/// The box or ball that cuts off the surface.
struct Bounds {
    Box box{dvec3(-1), dvec3(1)};
    bool is_ball = false; // the one that fills the box

    /// Returns how far outside of each limit a point lies, below 0 inside.
    double outside(const dvec3& p, int limit) const {
        if (is_ball)
            return glm::distance(p, box.center()) - 0.5 * box.extent().x;
        const int axis = limit / 2;
        return limit % 2 ? p[axis] - box.hi[axis] : box.lo[axis] - p[axis];
    }
    int limits() const { return is_ball ? 1 : 6; }
};

Bounds bounds_of(const Container& container) {
    if (const std::optional<RoundShape>& ball = container.shape.exact)
        return {{ball->base - ball->radius, ball->base + ball->radius}, true};
    return {container.box, false};
}

/// A corner with its u and v.
struct UvCorner : Corner {
    dvec2 uv;
};

/// Returns the part of a convex polygon that lies within one of the limits.
/// Based on: Sutherland and Hodgman 1974, "Reentrant Polygon Clipping".
std::vector<UvCorner> cut_off(const std::vector<UvCorner>& polygon, const Bounds& bounds,
                              int limit) {
    std::vector<UvCorner> kept;
    for (size_t i = 0; i < polygon.size(); ++i) {
        const UvCorner &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
        const double out_a = bounds.outside(a.position, limit);
        const double out_b = bounds.outside(b.position, limit);
        if (!(out_a > 0))
            kept.push_back(a);
        if ((out_a > 0) != (out_b > 0)) {
            const double share = out_a / (out_a - out_b);
            kept.push_back(
                {{glm::mix(a.position, b.position, share), glm::mix(a.normal, b.normal, share)},
                 glm::mix(a.uv, b.uv, share)});
        }
    }
    return kept;
}

struct Surface3 {
    Reader& reader;
    Token name;
    std::array<Function, 3> functions;
    dvec2 low{0}, high{1};
    Bounds bounds;

    dvec3 at(const dvec2& uv) const {
        const double given[2] = {uv.x, uv.y};
        dvec3 point;
        for (int i = 0; i < 3; ++i)
            point[i] = call(reader, name, functions[size_t(i)], given).v[0];
        return point;
    }

    UvCorner corner(const dvec2& uv) const {
        const dvec2 step = 1e-4 * (high - low);
        const dvec3 by_u = at(uv + dvec2(step.x, 0)) - at(uv - dvec2(step.x, 0));
        const dvec3 by_v = at(uv + dvec2(0, step.y)) - at(uv - dvec2(0, step.y));
        const dvec3 normal = glm::cross(by_u, by_v);
        const double length = glm::length(normal);
        return {{at(uv), length > 0 && std::isfinite(length) ? normal / length : dvec3(0)}, uv};
    }

    void add(std::vector<UvCorner> polygon, Facets& out) const {
        for (const Corner& corner : polygon)
            if (!is_finite(corner.position))
                return;
        for (int limit = 0; limit < bounds.limits(); ++limit)
            polygon = cut_off(polygon, bounds, limit);
        for (size_t i = 2; i < polygon.size(); ++i)
            out.add({polygon[0], polygon[i - 1], polygon[i]},
                    {polygon[0].uv, polygon[i - 1].uv, polygon[i].uv});
    }

    void cut(int steps, Facets& out) const {
        std::vector<UvCorner> below, above;
        for (int row = 0; row <= steps; ++row) {
            above.clear();
            for (int column = 0; column <= steps; ++column)
                above.push_back(corner(glm::mix(low, high, dvec2(column, row) / double(steps))));
            for (size_t i = 0; row > 0 && i < size_t(steps); ++i) {
                add({below[i], below[i + 1], above[i + 1]}, out);
                add({below[i], above[i + 1], above[i]}, out);
            }
            std::swap(below, above);
        }
    }
};

} // namespace

Shape parse_parametric(Reader& reader) {
    Surface3 surface{reader, reader.peek(), {}};
    for (Function& function : surface.functions) {
        if (!reader.take("function"))
            reader.fail_here("a function of u and v");
        function = parse_function(reader, {"u", "v"});
        reader.take_comma();
        if (!function.refused.empty())
            reader.fail(reader.place(), function.refused);
    }
    surface.low = parse_vector2(reader);
    reader.take_comma();
    surface.high = parse_vector2(reader);
    reader.take_comma();
    for (;;) {
        if (reader.take("contained_by"))
            surface.bounds = bounds_of(parse_container(reader));
        else if (reader.take("accuracy") || reader.take("max_gradient"))
            parse_float(reader);
        else if (reader.take("precompute")) { // DEPTH, x, y, z
            parse_float(reader);
            while (reader.take(',') || reader.take("x") || reader.take("y") || reader.take("z"))
                ;
        } else if (!reader.take(','))
            break;
    }
    Shape shape;
    shape.corners_have_uv = true;
    shape.per_square = 2;
    shape.box = surface.bounds.box;
    shape.cut = [surface = std::move(surface)](int segments, bool, Facets& out) {
        surface.cut(segments, out);
        out.smooth = true;
    };
    return shape;
}

} // namespace ovc::pov
