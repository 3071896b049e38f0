// SPDX-License-Identifier: Apache-2.0
// Intersects rays and triangles in exact arithmetic, to judge where two programs disagree: in
// integers, because a fraction finds its lowest terms at every step, which takes ten times as long.
#pragma once

#include "core/exact/triangle.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

namespace ovc::test {

using Rational = boost::multiprecision::cpp_rational;
using RationalVec = std::array<Rational, 3>;
using Integer = boost::multiprecision::cpp_int;
using IntegerVec = std::array<Integer, 3>;

inline RationalVec exact(const dvec3& v) {
    return {Rational(v.x), Rational(v.y), Rational(v.z)};
}

template <class T>
std::array<T, 3> minus(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class T>
std::array<T, 3> cross(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
template <class T>
T dot(const std::array<T, 3>& a, const std::array<T, 3>& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/// The largest power of two of which some finite doubles are multiples.
class Unit {
public:
    void add(const dvec3& v) {
        for (int axis = 0; axis < 3; ++axis)
            if (v[axis] != 0)
                exponent_ = std::min(exponent_, parts(v[axis]).second);
    }
    /// Valid once a number other than 0 was added.
    int exponent() const { return exponent_; }

    /// Returns numbers that were added as multiples of the unit.
    IntegerVec count(const dvec3& v) const { return {count(v.x), count(v.y), count(v.z)}; }

private:
    /// Returns an odd m, and e, such that x = m 2^e. x is not 0.
    static std::pair<int64_t, int> parts(double x) {
        int exponent = 0;
        const auto mantissa = int64_t(std::ldexp(std::frexp(x, &exponent), 53));
        const int zeros = std::countr_zero(uint64_t(mantissa));
        return {mantissa / (int64_t(1) << zeros), exponent - 53 + zeros};
    }
    Integer count(double x) const {
        if (x == 0)
            return 0;
        const auto [mantissa, exponent] = parts(x);
        return Integer(mantissa) * (Integer(1) << unsigned(exponent - exponent_));
    }

    int exponent_ = std::numeric_limits<int>::max();
};

/// Returns the double nearest to x. A tie goes to the even one, and an x beyond the largest double
/// to that.
inline double rounded(const Rational& x) {
    constexpr double largest = std::numeric_limits<double>::max();
    const Rational size = abs(x);
    double nearest = std::min(size.convert_to<double>(), largest); // This may be a little off.
    const auto nearer_to = [&](double other) {
        const Rational gain = abs(size - Rational(nearest)) - abs(size - Rational(other));
        return gain > 0 || (gain == 0 && std::bit_cast<uint64_t>(nearest) % 2 == 1);
    };
    while (nearest < largest && nearer_to(std::nextafter(nearest, largest)))
        nearest = std::nextafter(nearest, largest);
    while (nearest > 0 && nearer_to(std::nextafter(nearest, 0.0)))
        nearest = std::nextafter(nearest, 0.0);
    return x < 0 ? -nearest : nearest;
}

/// A hit of a ray and a triangle.
struct ExactHit {
    Rational t, u, v;
    TriangleId id;

    Hit rounded() const { return {test::rounded(t), test::rounded(u), test::rounded(v), id}; }
};

/// Returns the hit of the ray and the closed triangle within [t_min, t_max], or nothing if there is
/// none or if the ray runs within the triangle's plane.
/// Based on: Moeller and Trumbore 1997, without a single rounding.
inline std::optional<ExactHit> exact_hit(const Ray& ray, const Triangle& triangle,
                                         TriangleId id = {0, 0}) {
    Unit length, way;
    for (const dvec3& point : {triangle[0], triangle[1], triangle[2], ray.org})
        length.add(point);
    way.add(ray.dir);
    const IntegerVec a = length.count(triangle[0]);
    const IntegerVec ab = minus(length.count(triangle[1]), a);
    const IntegerVec ac = minus(length.count(triangle[2]), a);
    const IntegerVec dir = way.count(ray.dir);
    const IntegerVec p = cross(dir, ac);
    Integer det = dot(ab, p);
    if (det == 0)
        return std::nullopt;
    const int side = det < 0 ? -1 : 1;
    det *= side;
    const IntegerVec s = minus(length.count(ray.org), a);
    const Integer u = side * dot(s, p);
    if (u < 0 || u > det)
        return std::nullopt;
    const IntegerVec q = cross(s, ab);
    const Integer v = side * dot(dir, q);
    if (v < 0 || u + v > det)
        return std::nullopt;
    const Integer along = side * dot(ac, q);
    const int shift = length.exponent() - way.exponent();
    const Rational t = shift > 0 ? Rational(along * (Integer(1) << unsigned(shift)), det)
                                 : Rational(along, det * (Integer(1) << unsigned(-shift)));
    if (t < Rational(ray.t_min) || (std::isfinite(ray.t_max) && t > Rational(ray.t_max)))
        return std::nullopt;
    return ExactHit{t, Rational(u, det), Rational(v, det), id};
}

/// Returns the nearest of all triangles, exactly. Of equal t, the smaller id wins. Only triangles
/// whose box the ray comes near, by a margin that no rounding reaches, are computed exactly.
inline std::optional<ExactHit> exact_nearest(const Soup& soup, const std::vector<TriangleId>& ids,
                                             const Ray& ray) {
    std::optional<ExactHit> best;
    const PreparedRay p(ray);
    for (const TriangleId id : ids) {
        const Triangle triangle = soup.triangle(id);
        const Box box = bounds_of(triangle);
        const Box wide = box.padded(1e-6 * max_component(box.extent()) + 1e3 * p.margin(box) +
                                    4 * box.rounding());
        if (clip(p, wide, ray.t_min, ray.t_max).empty())
            continue;
        if (const auto hit = exact_hit(ray, triangle, id))
            if (!best || hit->t < best->t || (hit->t == best->t && id < best->id))
                best = hit;
    }
    return best;
}

} // namespace ovc::test
