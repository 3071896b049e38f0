// SPDX-License-Identifier: Apache-2.0
// Interpolates as POV-Ray 3.7 does. A cubic_spline is like Catmull and Rom's, but its slope at a
// point is the mean of those of both sides, however long they last.
#include "importers/pov/values/spline.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace ovc::pov {

Spline::Kind take_spline_kind(Reader& reader, Spline::Kind otherwise) {
    if (reader.take("linear_spline"))
        return Spline::Kind::Linear;
    if (reader.take("quadratic_spline"))
        return Spline::Kind::Quadratic;
    if (reader.take("cubic_spline"))
        return Spline::Kind::Cubic;
    if (reader.take("natural_spline"))
        return Spline::Kind::Natural;
    return otherwise;
}

Spline parse_spline(Reader& reader) {
    Spline spline;
    reader.expect('{', "spline");
    if (std::optional<Spline> other = take_named<Spline>(reader))
        spline = std::move(*other);
    spline.kind = take_spline_kind(reader, spline.kind);
    reader.take_comma();
    while (!reader.take('}')) {
        const Place at = reader.place();
        const double clock = parse_float(reader);
        if (std::isnan(clock))
            reader.fail(at, "found a spline's clock that is not a number");
        reader.take_comma();
        spline.points[clock] = parse_number(reader);
        reader.take_comma();
    }
    if (spline.points.empty())
        reader.fail(reader.place(), "found a spline without points");
    return spline;
}

namespace {

struct Point {
    double clock;
    Number value;
};

/// Returns component i at t of Lagrange's polynomial through three points.
double quadratic(const Point* p, size_t i, double t) {
    double sum = 0;
    for (int a = 0; a < 3; ++a) {
        double weight = p[a].value.v[i];
        for (int b = 0; b < 3; ++b)
            if (b != a)
                weight *= (t - p[b].clock) / (p[a].clock - p[b].clock);
        sum += weight;
    }
    return sum;
}

/// Returns component i at t of Hermite's polynomial between p[1] and p[2], whose slopes follow from
/// their neighbours. As measured of povray 3.7.0.10.
double cubic(const Point* p, size_t i, double t) {
    const auto slope = [&](int a) {
        return (p[a + 1].value.v[i] - p[a].value.v[i]) / (p[a + 1].clock - p[a].clock);
    };
    const double span = p[2].clock - p[1].clock;
    const double u = (t - p[1].clock) / span;
    const double m1 = 0.5 * (slope(0) + slope(1)) * span, m2 = 0.5 * (slope(1) + slope(2)) * span;
    const double v1 = p[1].value.v[i], v2 = p[2].value.v[i];
    return v1 + u * (m1 + u * (3 * (v2 - v1) - 2 * m1 - m2 + u * (2 * (v1 - v2) + m1 + m2)));
}

/// Returns the second derivatives of the natural spline through component i of the points.
std::vector<double> curvatures(const std::vector<Point>& p, size_t i) {
    const size_t n = p.size();
    assert(n >= 3);
    std::vector<double> m(n, 0), diagonal(n, 1), right(n, 0);
    for (size_t k = 1; k + 1 < n; ++k) {
        const double before = p[k].clock - p[k - 1].clock, after = p[k + 1].clock - p[k].clock;
        right[k] = 6 * ((p[k + 1].value.v[i] - p[k].value.v[i]) / after -
                        (p[k].value.v[i] - p[k - 1].value.v[i]) / before);
        diagonal[k] = 2 * (before + after);
        if (k > 1) {
            const double f = before / diagonal[k - 1];
            diagonal[k] -= f * before;
            right[k] -= f * right[k - 1];
        }
    }
    for (size_t k = n - 1; k-- > 1;)
        m[k] = (right[k] - (p[k + 1].clock - p[k].clock) * m[k + 1]) / diagonal[k];
    return m;
}

/// Returns the clock, moved to where a cubic_spline is defined: the first and the last point only
/// give slopes, and of two points the spline is the middle.
double within_cubic(const std::vector<Point>& p, double clock) {
    const size_t n = p.size();
    if (n == 2)
        return 0.5 * (p[0].clock + p[1].clock);
    return n > 2 && !std::isnan(clock) ? std::clamp(clock, p[1].clock, p[n - 2].clock) : clock;
}

double natural(const std::vector<Point>& p, size_t k, size_t i, double t) {
    const std::vector<double> m = curvatures(p, i);
    const double h = p[k + 1].clock - p[k].clock;
    const double a = (p[k + 1].clock - t) / h, b = (t - p[k].clock) / h;
    return a * p[k].value.v[i] + b * p[k + 1].value.v[i] +
           ((a * a * a - a) * m[k] + (b * b * b - b) * m[k + 1]) * h * h / 6;
}

} // namespace

Number at(const Spline& spline, Spline::Kind asked, double clock) {
    assert(!spline.points.empty());
    std::vector<Point> p;
    int size = 1;
    for (const auto& [t, value] : spline.points) {
        p.push_back({t, value});
        size = std::max(size, value.size);
    }
    for (Point& point : p)
        if (point.value.size == 1)
            point.value.v.fill(point.value.v[0]);
    if (asked == Spline::Kind::Cubic)
        clock = within_cubic(p, clock);
    Number result = clock <= p.front().clock ? p.front().value : p.back().value;
    result.size = size;
    if (!(clock > p.front().clock && clock < p.back().clock)) // NaN is in no piece
        return result;
    const size_t needed = asked == Spline::Kind::Cubic ? 4 : 3;
    const Spline::Kind kind = p.size() < needed ? Spline::Kind::Linear : asked;
    const size_t last = p.size() - (kind == Spline::Kind::Cubic ? 3 : 2);
    size_t k = 0; // the piece between points k and k + 1
    while (k < last && p[k + 1].clock <= clock)
        ++k;
    for (size_t i = 0; i < size_t(size); ++i) {
        const double u = (clock - p[k].clock) / (p[k + 1].clock - p[k].clock);
        switch (kind) {
        case Spline::Kind::Linear:
            result.v[i] = (1 - u) * p[k].value.v[i] + u * p[k + 1].value.v[i];
            break;
        case Spline::Kind::Quadratic:
            result.v[i] = quadratic(&p[k > 0 ? k - 1 : 0], i, clock);
            break;
        case Spline::Kind::Cubic:
            result.v[i] = cubic(&p[k - 1], i, clock);
            break;
        case Spline::Kind::Natural:
            result.v[i] = natural(p, k, i, clock);
            break;
        }
    }
    return result;
}

} // namespace ovc::pov
