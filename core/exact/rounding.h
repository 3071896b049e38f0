// SPDX-License-Identifier: Apache-2.0
// Rounding: computes a solution in doubled precision with bounds of its errors, and rounds t, u and
// v of a hit once, where the bounds tell how. V is double or a vector of doubles.
#pragma once

#include "core/exact/solution.h"

namespace ovc {

/// Triangles (a, b, c), and the lines org + t dir that may meet them.
template <class V>
struct Meeting {
    Vec3Of<V> a, b, c, org, dir;
};

/// A solution, and how far each of its numbers may be off.
template <class V>
struct BoundedSolution {
    Solution<DoubleDoubleOf<V>> value;
    Solution<V> error;

    OVC_INLINE DoubleDoubleOf<V> w() const { return value.w(); }
    OVC_INLINE V w_error() const { return V{} + 2 * (error.det + error.u + error.v); }
};

template <class V>
OVC_INLINE Vec3Of<DoubleDoubleOf<V>> exact_difference(const Vec3Of<V>& a, const Vec3Of<V>& b) {
    return {two_difference(a.x, b.x), two_difference(a.y, b.y), two_difference(a.z, b.z)};
}

template <class V>
OVC_INLINE Vec3Of<MagnitudeOf<V>> magnitudes(const Vec3Of<V>& v) {
    return {{Lanes<V>::magnitude(v.x)}, {Lanes<V>::magnitude(v.y)}, {Lanes<V>::magnitude(v.z)}};
}
template <class V>
OVC_INLINE Vec3Of<MagnitudeOf<V>> magnitudes(const Vec3Of<DoubleDoubleOf<V>>& v) {
    return magnitudes(Vec3Of<V>{v.x.hi, v.y.hi, v.z.hi});
}

template <class V>
OVC_INLINE V total(const Vec3Of<MagnitudeOf<V>>& v) {
    return v.x.value + v.y.value + v.z.value;
}

/// The bounds are derived in docs/design/numerics.md, "The reference".
template <class V>
OVC_INLINE BoundedSolution<V> bounded_solution(const Meeting<V>& m) {
    constexpr double kBound = 0x1p-101;      // 32 v^2
    constexpr double kUnderflow = 0x1p-1020; // the loss to underflow in products of two
    const Vec3Of<DoubleDoubleOf<V>> ab = exact_difference(m.b, m.a);
    const Vec3Of<DoubleDoubleOf<V>> ac = exact_difference(m.c, m.a);
    const Vec3Of<DoubleDoubleOf<V>> from_a = exact_difference(m.org, m.a);
    const Vec3Of<MagnitudeOf<V>> ab_size = magnitudes(ab), ac_size = magnitudes(ac);
    const Vec3Of<MagnitudeOf<V>> from_a_size = magnitudes(from_a);
    const Vec3Of<MagnitudeOf<V>> dir_size = magnitudes(m.dir);
    const Solution<MagnitudeOf<V>> size = solve(ab_size, ac_size, from_a_size, dir_size);
    const V lost = kUnderflow *
                   (1 + (total(ab_size) + total(ac_size)) + (total(from_a_size) + total(dir_size)));
    return {solve(ab, ac, from_a, m.dir),
            {kBound * size.det.value + lost, kBound * size.u.value + lost,
             kBound * size.v.value + lost, kBound * size.t.value + lost}};
}

/// A quotient in doubled precision, and its error: the exact number lies within `error` of value.hi
/// + value.lo.
template <class V>
struct Quotient {
    DoubleDoubleOf<V> value;
    V error;

    /// Returns whether every number within the bound rounds to value.hi: nonzero or true if so.
    OVC_INLINE auto is_rounded() const {
        return (value.hi + (value.lo + error) == value.hi) &
               (value.hi + (value.lo - error) == value.hi);
    }
};

/// Returns numerator / denominator, whose errors are bounds. inverse: 1 / denominator.hi.
template <class V>
OVC_INLINE Quotient<V> quotient(const DoubleDoubleOf<V>& numerator, V numerator_error,
                                const DoubleDoubleOf<V>& denominator, V denominator_error,
                                V inverse) {
    const V first = numerator.hi * inverse;
    const DoubleDoubleOf<V> rest = numerator - denominator * first;
    const DoubleDoubleOf<V> value = fast_two_sum(first, rest.hi * inverse);
    const V size = Lanes<V>::magnitude(first);
    const V carried = (numerator_error + size * denominator_error) * Lanes<V>::magnitude(inverse);
    return {value, 2 * carried + (0x1p-101 * size + 0x1p-1020)};
}

} // namespace ovc
