// SPDX-License-Identifier: Apache-2.0
// Rounding: computes a solution in doubled precision with bounds of its errors, and rounds t, u and
// v of a hit once, where the bounds tell how. V is double or a vector of doubles. The bounds are
// derived in docs/design/numerics.md, "The reference".
#pragma once

#include "core/exact/solution.h"

#include <array>
#include <cstddef>

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

/// The exact vectors of a meeting, and bounds of what errors of a solution are in proportion to.
template <class V>
struct MeetingVectors {
    Vec3Of<DoubleDoubleOf<V>> ab, ac, from_a;
    Vec3Of<V> dir;
    Solution<V> size; // the sums of the magnitudes of all terms
    V lost;           // to underflow

    OVC_INLINE explicit MeetingVectors(const Meeting<V>& m)
        : ab(exact_difference(m.b, m.a)),
          ac(exact_difference(m.c, m.a)),
          from_a(exact_difference(m.org, m.a)),
          dir(m.dir) {
        constexpr double kUnderflow = 0x1p-1020; // in products of two
        const Vec3Of<MagnitudeOf<V>> ab_size = magnitudes(ab), ac_size = magnitudes(ac);
        const Vec3Of<MagnitudeOf<V>> from_size = magnitudes(from_a), dir_size = magnitudes(dir);
        const Solution<MagnitudeOf<V>> sizes = solve(ab_size, ac_size, from_size, dir_size);
        size = {sizes.det.value, sizes.u.value, sizes.v.value, sizes.t.value};
        lost = kUnderflow *
               (1 + (total(ab_size) + total(ac_size)) + (total(from_size) + total(dir_size)));
    }
};

/// A product, or a sum of some, that is yet to become a DoubleDouble: hi + lo, where lo may be a
/// few v |hi|, or of the terms. That saves a fifth of the additions (docs/design/numerics.md).
template <class V>
struct TermsOf {
    V hi, lo;

    OVC_INLINE TermsOf operator+(const TermsOf& other) const {
        const DoubleDoubleOf<V> sum = two_sum(hi, other.hi);
        return {sum.hi, sum.lo + (lo + other.lo)};
    }
    OVC_INLINE TermsOf operator-(const TermsOf& other) const {
        return *this + TermsOf{-other.hi, -other.lo};
    }
    OVC_INLINE DoubleDoubleOf<V> total() const { return fast_two_sum(hi, lo); }
};

template <class V>
OVC_INLINE TermsOf<V> term(const DoubleDoubleOf<V>& a, V b) {
    const DoubleDoubleOf<V> product = two_product(a.hi, b);
    return {product.hi, product.lo + a.lo * b};
}
template <class V>
OVC_INLINE TermsOf<V> term(const DoubleDoubleOf<V>& a, const DoubleDoubleOf<V>& b) {
    const DoubleDoubleOf<V> product = two_product(a.hi, b.hi);
    return {product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi)};
}

template <class V, class B>
OVC_INLINE Vec3Of<DoubleDoubleOf<V>> cross_of_terms(const Vec3Of<DoubleDoubleOf<V>>& a,
                                                    const Vec3Of<B>& b) {
    return {(term(a.y, b.z) - term(a.z, b.y)).total(), (term(a.z, b.x) - term(a.x, b.z)).total(),
            (term(a.x, b.y) - term(a.y, b.x)).total()};
}
template <class V, class B>
OVC_INLINE DoubleDoubleOf<V> dot_of_terms(const Vec3Of<DoubleDoubleOf<V>>& a, const Vec3Of<B>& b) {
    return (term(a.x, b.x) + term(a.y, b.y) + term(a.z, b.z)).total();
}

/// solve() of core/exact/solution.h, off by at most 48 v^2 of the sums of the magnitudes.
template <class V>
OVC_INLINE Solution<DoubleDoubleOf<V>> solve_in_terms(const MeetingVectors<V>& m) {
    const auto p = cross_of_terms(m.ac, m.dir);
    const auto q = cross_of_terms(m.from_a, m.ab);
    return {-dot_of_terms(m.ab, p), -dot_of_terms(m.from_a, p), dot_of_terms(q, m.dir),
            dot_of_terms(q, m.ac)};
}

template <class V>
OVC_INLINE BoundedSolution<V> bounded_solution(const MeetingVectors<V>& m) {
    constexpr double kBound = 0x1p-100; // 64 v^2
    return {solve_in_terms(m),
            {kBound * m.size.det + m.lost, kBound * m.size.u + m.lost, kBound * m.size.v + m.lost,
             kBound * m.size.t + m.lost}};
}

/// The sum of three doubles, of which the first need not be the largest.
template <class V>
using ThreeDoubles = std::array<V, 3>;

/// Adds so many terms, off by at most n^3 v^3 of the sum of their magnitudes. Based on: Ogita, Rump
/// and Oishi 2005, "Accurate Sum and Dot Product", algorithm 4.8 (SumK), K = 3.
template <class V, size_t n>
OVC_INLINE ThreeDoubles<V> sum_closely(std::array<V, n> terms) {
    for (size_t pass = 0; pass < 2; ++pass)
        for (size_t i = 1; i < n - pass; ++i) {
            const DoubleDoubleOf<V> sum = two_sum(terms[i], terms[i - 1]);
            terms[i] = sum.hi;
            terms[i - 1] = sum.lo;
        }
    V rest = terms[0];
    for (size_t i = 1; i + 2 < n; ++i)
        rest = rest + terms[i];
    return {terms[n - 1], terms[n - 2], rest};
}

/// Appends terms that a product is the sum of, exactly.
template <class V>
OVC_INLINE V* put_product(V* to, V a, V b) {
    const DoubleDoubleOf<V> product = two_product(a, b);
    *to++ = product.hi;
    *to++ = product.lo;
    return to;
}
template <class V>
OVC_INLINE V* put_product(V* to, const DoubleDoubleOf<V>& a, V b) {
    return put_product(put_product(to, a.hi, b), a.lo, b);
}
template <class V>
OVC_INLINE V* put_product(V* to, const DoubleDoubleOf<V>& a, const DoubleDoubleOf<V>& b) {
    return put_product(put_product(to, a, b.hi), a, b.lo);
}

/// Returns a b - c d.
template <class V, class B>
OVC_INLINE ThreeDoubles<V> cross_closely(const DoubleDoubleOf<V>& a, const B& b,
                                         const DoubleDoubleOf<V>& c, const B& d) {
    constexpr size_t kProduct = sizeof(B) == sizeof(V) ? 4 : 8; // terms
    std::array<V, 2 * kProduct> terms;
    put_product(put_product(terms.data(), a, b), -c, d);
    return sum_closely(terms);
}

template <class V>
OVC_INLINE V* put_product(V* to, const ThreeDoubles<V>& a, V b) {
    to = put_product(put_product(to, a[0], b), a[1], b);
    *to++ = a[2] * b;
    return to;
}
/// The last terms are rounded: they are smaller by 2^-100 than the first.
template <class V>
OVC_INLINE V* put_product(V* to, const ThreeDoubles<V>& a, const DoubleDoubleOf<V>& b) {
    to = put_product(put_product(to, a, b.hi), a[0], b.lo);
    *to++ = a[1] * b.lo;
    return to;
}

template <class V, class B>
OVC_INLINE DoubleDoubleOf<V> dot_closely(const std::array<ThreeDoubles<V>, 3>& a,
                                         const Vec3Of<B>& b) {
    constexpr size_t kProduct = sizeof(B) == sizeof(V) ? 5 : 8; // terms
    std::array<V, 3 * kProduct> terms;
    put_product(put_product(put_product(terms.data(), a[0], b.x), a[1], b.y), a[2], b.z);
    const ThreeDoubles<V> sum = sum_closely(terms);
    const DoubleDoubleOf<V> first = two_sum(sum[0], sum[1]);
    return two_sum(first.hi, first.lo + sum[2]);
}

/// u and v of a solution to within 2^-140 of the magnitudes of their terms: that tells how they
/// round where a ray passes a side by a rounding, and they are tiny.
template <class V>
struct CloseWeights {
    DoubleDoubleOf<V> u, v;
    V u_error, v_error;

    OVC_INLINE explicit CloseWeights(const MeetingVectors<V>& m) {
        constexpr double kBound = 0x1p-140;
        const auto &ab = m.ab, &ac = m.ac, &from_a = m.from_a;
        const std::array<ThreeDoubles<V>, 3> p = {cross_closely(ac.y, m.dir.z, ac.z, m.dir.y),
                                                  cross_closely(ac.z, m.dir.x, ac.x, m.dir.z),
                                                  cross_closely(ac.x, m.dir.y, ac.y, m.dir.x)};
        u = -dot_closely(p, from_a);
        const std::array<ThreeDoubles<V>, 3> q = {cross_closely(from_a.y, ab.z, from_a.z, ab.y),
                                                  cross_closely(from_a.z, ab.x, from_a.x, ab.z),
                                                  cross_closely(from_a.x, ab.y, from_a.y, ab.x)};
        v = dot_closely(q, m.dir);
        u_error = kBound * m.size.u + m.lost;
        v_error = kBound * m.size.v + m.lost;
    }
};

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
