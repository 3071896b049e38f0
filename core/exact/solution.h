// SPDX-License-Identifier: Apache-2.0
// Solution: where a line meets the plane of a triangle, in any kind of number. Based on: Moeller
// and Trumbore 1997, "Fast, Minimum Storage Ray/Triangle Intersection", without its divisions.
#pragma once

#include "core/exact/double_double.h"

namespace ovc {

/// The line org + t dir meets the plane of (a, b, c) at t / det, in the point (w a + u b + v c) /
/// det. All are 0 where the line lies in the plane; only det is where it is parallel to it.
template <class Number>
struct Solution {
    Number det, u, v, t;

    OVC_INLINE Number w() const { return det - u - v; }
};

template <class Number>
struct Vec3Of {
    Number x, y, z;
};

template <class A, class B>
OVC_INLINE auto cross(const Vec3Of<A>& a, const Vec3Of<B>& b) {
    using Product = decltype(a.x * b.x);
    return Vec3Of<Product>{a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class A, class B>
OVC_INLINE auto dot(const Vec3Of<A>& a, const Vec3Of<B>& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}

/// Solves for ab = b - a, ac = c - a and from_a = org - a. Number * Component is a Number.
template <class Number, class Component>
OVC_INLINE Solution<Number> solve(const Vec3Of<Number>& ab, const Vec3Of<Number>& ac,
                                  const Vec3Of<Number>& from_a, const Vec3Of<Component>& dir) {
    const Vec3Of<Number> p = cross(ac, dir);
    const Vec3Of<Number> q = cross(from_a, ab);
    return {-dot(ab, p), -dot(from_a, p), dot(q, dir), dot(q, ac)};
}

/// Sums the magnitudes of all terms, added or subtracted. Solution<MagnitudeOf<V>> bounds how far
/// roundings can move a Solution.
template <class V>
struct MagnitudeOf {
    V value;

    OVC_INLINE MagnitudeOf operator+(MagnitudeOf b) const { return {value + b.value}; }
    OVC_INLINE MagnitudeOf operator-(MagnitudeOf b) const { return {value + b.value}; }
    OVC_INLINE MagnitudeOf operator*(MagnitudeOf b) const { return {value * b.value}; }
    OVC_INLINE MagnitudeOf operator-() const { return *this; }
};

} // namespace ovc
