// SPDX-License-Identifier: Apache-2.0
// Reads sphere_sweep: the space that a ball fills which moves along a spline and whose radius
// follows one too.
#include "importers/pov/shapes/implicit.h"
#include "importers/pov/shapes/shape.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace ovc::pov {

namespace {

/// A piece of a curve is cut into so many straight ones.
constexpr int kStepsAPiece = 24;
constexpr double kMaxCells = 256; // along the longest side, which bounds the memory

struct Ball {
    dvec3 center;
    double radius;
};

/// The space that a ball fills which moves straight and grows evenly.
struct TaperedCapsule {
    Ball a, b;

    /// Returns the distance to the surface, below 0 inside.
    double distance(const dvec3& p) const {
        const dvec3 way = b.center - a.center, off = p - a.center;
        const double length = glm::length(way);
        const double growth = length > 0 ? (b.radius - a.radius) / length : 1;
        if (!(std::abs(growth) < 1)) { // one ball holds the other
            const Ball& larger = a.radius > b.radius ? a : b;
            return glm::distance(p, larger.center) - larger.radius;
        }
        const double along = glm::dot(off, way) / length;
        const double across = std::sqrt(std::max(0.0, glm::dot(off, off) - along * along));
        // The nearest ball's center is where a tangent from the point meets the axis.
        const double at =
            std::clamp(along + across * growth / std::sqrt(1 - growth * growth), 0.0, length);
        return std::hypot(along - at, across) - (a.radius + growth * at);
    }

    Box box() const {
        Box all;
        for (const Ball& ball : {a, b}) {
            all.add(ball.center - ball.radius);
            all.add(ball.center + ball.radius);
        }
        return all;
    }
};

using Capsules = std::vector<TaperedCapsule>;

enum class SweepSpline { Linear, BSpline, CatmullRom };

/// Returns the ball at `t` of the piece between the second and the third of four. Factors of a
/// ball's four numbers: of the uniform cubic B-spline, or of Catmull and Rom 1974.
Ball ball_at(const Ball* four, double t, SweepSpline spline) {
    const double s = 1 - t;
    std::array<double, 4> f{s * s * s / 6, (4 - 6 * t * t + 3 * t * t * t) / 6,
                            (4 - 6 * s * s + 3 * s * s * s) / 6, t * t * t / 6};
    if (spline == SweepSpline::CatmullRom)
        f = {-0.5 * t * s * s, 1 + t * t * (1.5 * t - 2.5), 1 + s * s * (1.5 * s - 2.5),
             -0.5 * s * t * t};
    Ball ball{dvec3(0), 0};
    for (size_t i = 0; i < 4; ++i) {
        ball.center += f[i] * four[i].center;
        ball.radius += f[i] * four[i].radius;
    }
    ball.radius = std::max(ball.radius, 0.0);
    return ball;
}

Capsules capsules_of(const std::vector<Ball>& balls, SweepSpline spline) {
    Capsules capsules;
    if (spline == SweepSpline::Linear) {
        for (size_t i = 0; i + 1 < balls.size(); ++i)
            capsules.push_back({balls[i], balls[i + 1]});
        return capsules;
    }
    for (size_t i = 0; i + 3 < balls.size(); ++i)
        for (int step = 0; step < kStepsAPiece; ++step)
            capsules.push_back({ball_at(&balls[i], double(step) / kStepsAPiece, spline),
                                ball_at(&balls[i], double(step + 1) / kStepsAPiece, spline)});
    return capsules;
}

std::function<double(const dvec3&)> distance_to(Capsules capsules) {
    return [capsules = std::move(capsules)](const dvec3& p) {
        double nearest = 1e300;
        for (const TaperedCapsule& capsule : capsules)
            nearest = std::min(nearest, capsule.distance(p));
        return nearest;
    };
}

/// The field refers to the capsules.
Field field_of(const Capsules& capsules) {
    Field field;
    field.value = distance_to(capsules);
    const PartsByPlace by_place(capsules, [](const TaperedCapsule& c) { return c.box(); });
    field.within = [by_place](const Box& asked) {
        // Those that may be the nearest to a point of the box on either side of the surface.
        return distance_to(by_place.near(asked.padded(max_component(asked.extent()))));
    };
    return field;
}

SweepSpline parse_spline_kind(Reader& reader) {
    if (reader.take("b_spline"))
        return SweepSpline::BSpline;
    if (reader.take("cubic_spline"))
        return SweepSpline::CatmullRom;
    if (!reader.take("linear_spline"))
        reader.fail_here("linear_spline, b_spline or cubic_spline");
    return SweepSpline::Linear;
}

} // namespace

Shape parse_sphere_sweep(Reader& reader) {
    const SweepSpline spline = parse_spline_kind(reader);
    reader.take_comma();
    const int count = parse_count(reader, spline == SweepSpline::Linear ? 2 : 4);
    std::vector<Ball> balls;
    for (int i = 0; i < count; ++i) {
        reader.take_comma();
        const dvec3 center = parse_vector(reader);
        reader.take_comma();
        balls.push_back({center, std::abs(parse_float(reader))});
        reader.grow(sizeof(Ball));
    }
    if (reader.take("tolerance"))
        parse_float(reader); // --tolerance says how exactly shapes are cut
    Capsules capsules = capsules_of(balls, spline);
    Box box;
    double thinnest = 1e300;
    for (const TaperedCapsule& capsule : capsules) {
        box.add(capsule.box());
        thinnest = std::min(thinnest, std::max(capsule.a.radius, capsule.b.radius));
    }
    Shape shape;
    shape.per_square = 4; // a surface net has about two triangles for each cell that it crosses
    shape.box = box;
    shape.cut = [capsules = std::move(capsules), box, thinnest](int segments, bool, Facets& out) {
        const double length = max_component(box.extent());
        if (!(length > 0))
            return;
        const double wanted = 0.25 * segments * length / (2 * thinnest);
        const double min_cells = std::min<double>(field_cells(segments), kMaxCells);
        cut_field(field_of(capsules), box.padded(0.01 * length),
                  int(std::clamp(wanted, min_cells, kMaxCells)), out);
        out.smooth = true;
    };
    return shape;
}

} // namespace ovc::pov
