// SPDX-License-Identifier: Apache-2.0
// Reads julia_fractal: the points in a hyperplane of four dimensions that stay near the origin
// while z becomes f(z) + c. POV-Ray's documentation (section 3.4.1.6, "Julia Fractal") has the
// rules of its two algebras.
#include "core/system/parallel.h"
#include "importers/pov/shapes/implicit.h"
#include "importers/pov/shapes/shape.h"

#include <array>
#include <cmath>
#include <complex>
#include <string_view>
#include <utility>

namespace ovc::pov {

namespace {

using Complex = std::complex<double>;
using Point4 = std::array<double, 4>; // x + y i + z j + w k

double square_of(const Point4& p) {
    return p[0] * p[0] + p[1] * p[1] + p[2] * p[2] + p[3] * p[3];
}

using ComplexFunction = Complex (*)(const Complex&);
constexpr std::pair<std::string_view, ComplexFunction> kFunctions[] = {
    {"sqr", [](const Complex& x) { return x * x; }},
    {"cube", [](const Complex& x) { return x * x * x; }},
    {"exp", [](const Complex& x) { return std::exp(x); }},
    {"reciprocal", [](const Complex& x) { return 1.0 / x; }},
    {"sin", [](const Complex& x) { return std::sin(x); }},
    {"asin", [](const Complex& x) { return std::asin(x); }},
    {"sinh", [](const Complex& x) { return std::sinh(x); }},
    {"asinh", [](const Complex& x) { return std::asinh(x); }},
    {"cos", [](const Complex& x) { return std::cos(x); }},
    {"acos", [](const Complex& x) { return std::acos(x); }},
    {"cosh", [](const Complex& x) { return std::cosh(x); }},
    {"acosh", [](const Complex& x) { return std::acosh(x); }},
    {"tan", [](const Complex& x) { return std::tan(x); }},
    {"atan", [](const Complex& x) { return std::atan(x); }},
    {"tanh", [](const Complex& x) { return std::tanh(x); }},
    {"atanh", [](const Complex& x) { return std::atanh(x); }},
    {"ln", [](const Complex& x) { return std::log(x); }}};
constexpr ComplexFunction kSquare = kFunctions[0].second, kCube = kFunctions[1].second;

struct JuliaSet {
    Point4 c{};
    Point4 normal{0, 0, 0, 1}; // of the hyperplane, of any length, whose distance is
    double distance = 0;       // from the origin
    int iterations = 20;
    bool quaternions = true;
    ComplexFunction function = kSquare; // null: a power
    Complex power = 0;

    Point4 of_quaternion(const Point4& p) const {
        const double a = p[0], rest = square_of(p) - a * a;
        const bool cube = function == kCube;
        const double real = cube ? a * (a * a - 3 * rest) : a * a - rest;
        const double along = cube ? 3 * a * a - rest : 2 * a;
        return {real, along * p[1], along * p[2], along * p[3]};
    }

    Complex of_complex(const Complex& z) const {
        return function ? function(z) : std::pow(z, power);
    }

    /// Hypercomplex numbers are pairs of complex ones: those by (1 + k) / 2 and by (1 - k) / 2.
    Point4 of_hypercomplex(const Point4& p) const {
        const Complex u = of_complex({p[0] + p[3], p[1] - p[2]});
        const Complex v = of_complex({p[0] - p[3], p[1] + p[2]});
        return {0.5 * (u.real() + v.real()), 0.5 * (u.imag() + v.imag()),
                0.5 * (v.imag() - u.imag()), 0.5 * (u.real() - v.real())};
    }

    /// Returns the distance of no return, beyond which povray draws no part of the set.
    double farthest() const { return quaternions ? 1 + std::sqrt(square_of(c)) : 4; }

    /// Returns the square of the distance that so many iterations lead to, at most, from the
    /// origin. They end beyond `limit`.
    double square_after(const dvec3& at, int steps, double limit) const {
        const double off = distance * std::sqrt(square_of(normal)) - normal[0] * at.x -
                           normal[1] * at.y - normal[2] * at.z;
        Point4 z{at.x, at.y, at.z, off / normal[3]};
        double square = square_of(z);
        for (int i = 0; i < steps && square <= limit; ++i) {
            z = quaternions ? of_quaternion(z) : of_hypercomplex(z);
            for (size_t k = 0; k < 4; ++k)
                z[k] += c[k];
            square = square_of(z);
        }
        return square;
    }

    /// Returns whether the last iteration does not reach the distance of no return.
    bool holds(const dvec3& at) const {
        const double limit = farthest() * farthest();
        return square_after(at, iterations - 1, limit) < limit;
    }

    /// Returns a number that is 0 where the last iteration reaches the distance of no return, and
    /// below 0 where none does. Where povray's rays meet the set, the iteration before the last has
    /// gone a distance of 1 + |c| among quaternions, and of 4 among hypercomplex numbers.
    double operator()(const dvec3& at) const {
        const double limit = farthest() * farthest();
        const double value = std::log(square_after(at, iterations - 1, limit) / limit);
        return value >= -3 ? std::min(value, 3.0) : std::isnan(value) ? 3.0 : -3.0;
    }

    /// Returns the direction in which the last iteration leads farther, as povray's normals do; 0
    /// where there is none.
    dvec3 normal_at(const dvec3& at) const {
        constexpr double kStep = 1e-6, kEndless = 1e100;
        dvec3 slope;
        for (int axis = 0; axis < 3; ++axis) {
            dvec3 step(0);
            step[axis] = kStep;
            slope[axis] = std::log(square_after(at + step, iterations, kEndless) /
                                   square_after(at - step, iterations, kEndless));
        }
        const double length = glm::length(slope);
        return length > 0 && std::isfinite(length) ? slope / length : dvec3(0);
    }
};

Point4 parse_point(Reader& reader) {
    const Number n = resized(reader, parse_number(reader), 4);
    return {n.v[0], n.v[1], n.v[2], n.v[3]};
}

/// Takes the name of a function that is iterated. Returns false where none is next.
bool take_function(Reader& reader, JuliaSet& set) {
    for (const auto& [name, function] : kFunctions)
        if (reader.take(name)) {
            set.function = function;
            return true;
        }
    if (!reader.take("pwr"))
        return false;
    set.function = nullptr;
    reader.expect('(', "pwr");
    const double real = parse_float(reader);
    reader.take_comma();
    set.power = {real, parse_float(reader)};
    reader.expect(')', "pwr");
    return true;
}

/// Returns a box around the set, by looking at a grid of points.
Box box_of(const JuliaSet& set) {
    constexpr int kHalf = 60;
    const double step = set.farthest() / kHalf;
    std::array<Box, 2 * kHalf + 1> layers;
    parallel_for(layers.size(), 1, [&](size_t first, size_t last) {
        for (size_t k = first; k < last; ++k)
            for (int i = -kHalf; i <= kHalf; ++i)
                for (int j = -kHalf; j <= kHalf; ++j) {
                    const dvec3 at = step * dvec3(i, j, double(k) - kHalf);
                    if (!layers[k].contains(at) && set.holds(at))
                        layers[k].add(at);
                }
    });
    Box box;
    for (const Box& layer : layers)
        if (!layer.empty()) {
            box.add(layer.lo);
            box.add(layer.hi);
        }
    return box.empty() ? box : box.padded(2 * step);
}

/// Sets have folds of all sizes, so they are cut finer than smooth shapes.
void cut_set(const JuliaSet& set, int segments, Facets& out) {
    const size_t first = out.corners.size();
    cut_field({set, {}}, box_of(set), 2 * segments, out);
    parallel_for(out.corners.size() - first, 1024, [&](size_t from, size_t to) {
        for (size_t i = first + from; i < first + to; ++i)
            out.corners[i].normal = set.normal_at(out.corners[i].position);
    });
    out.smooth = true;
}

} // namespace

Shape parse_julia_fractal(Reader& reader) {
    JuliaSet set;
    set.c = parse_point(reader);
    const Place place = reader.place();
    for (;;) {
        if (reader.take("quaternion"))
            set.quaternions = true;
        else if (reader.take("hypercomplex"))
            set.quaternions = false;
        else if (reader.take("max_iteration"))
            set.iterations = parse_int(reader, 1, 1000, "max_iteration");
        else if (reader.take("precision"))
            parse_float(reader); // the tolerance says how exactly shapes are cut
        else if (reader.take("slice")) {
            set.normal = parse_point(reader);
            reader.take_comma();
            set.distance = parse_float(reader);
        } else if (!take_function(reader, set) && !reader.take(','))
            break;
    }
    if (set.quaternions && set.function != kSquare && set.function != kCube)
        reader.fail(place, "found a function of quaternions other than sqr and cube");
    if (!(std::abs(set.normal[3]) > 0))
        reader.fail(place, "found a slice whose fourth component is 0");
    Shape shape;
    shape.per_square = 28; // as measured: 24 to 32
    shape.box = Box{dvec3(0), dvec3(0)}.padded(set.farthest());
    shape.cut = [set](int segments, bool, Facets& out) { cut_set(set, segments, out); };
    return shape;
}

} // namespace ovc::pov
