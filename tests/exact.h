// SPDX-License-Identifier: Apache-2.0
// Intersects rays and triangles in exact rational arithmetic, to judge where two programs disagree.
#pragma once

#include "core/exact/triangle.h"

#include <boost/multiprecision/cpp_int.hpp>

#include <array>
#include <bit>
#include <limits>
#include <optional>
#include <vector>

namespace ovc::test {

using Rational = boost::multiprecision::cpp_rational;
using RationalVec = std::array<Rational, 3>;

inline RationalVec exact(const dvec3& v) {
    return {Rational(v.x), Rational(v.y), Rational(v.z)};
}

inline RationalVec minus(const RationalVec& a, const RationalVec& b) {
    return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
inline RationalVec cross(const RationalVec& a, const RationalVec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline Rational dot(const RationalVec& a, const RationalVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

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
    const RationalVec a = exact(triangle[0]);
    const RationalVec ab = minus(exact(triangle[1]), a);
    const RationalVec ac = minus(exact(triangle[2]), a);
    const RationalVec dir = exact(ray.dir);
    const RationalVec p = cross(dir, ac);
    const Rational det = dot(ab, p);
    if (det == 0)
        return std::nullopt;
    const RationalVec s = minus(exact(ray.org), a);
    const Rational u = dot(s, p) / det;
    if (u < 0 || u > 1)
        return std::nullopt;
    const RationalVec q = cross(s, ab);
    const Rational v = dot(dir, q) / det;
    if (v < 0 || u + v > 1)
        return std::nullopt;
    const Rational t = dot(ac, q) / det;
    if (t < Rational(ray.t_min) || (std::isfinite(ray.t_max) && t > Rational(ray.t_max)))
        return std::nullopt;
    return ExactHit{t, u, v, id};
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
