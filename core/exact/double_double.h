// SPDX-License-Identifier: Apache-2.0
// DoubleDouble: a sum of two doubles, about 106 bits. Based on: Dekker 1971, "A Floating-Point
// Technique for Extending the Available Precision"; error bounds as in Joldes, Muller and Popescu
// 2017, with simpler constants. v is 2^-53. All bounds hold as long as nothing overflows; a product
// that underflows adds 2^-1074. V is double, or a vector of doubles
// (core/lanes/hit_lanes_kernel.h); everything is inlined, because the latter is compiled for
// several processors.
#pragma once

#include <cmath>

#define OVC_INLINE [[gnu::always_inline]] inline

namespace ovc {

/// The operations that vectors have no operators for. product_error(a, b, product) is a b -
/// product, exactly, where product is a b rounded; magnitude(x) is |x|.
template <class V>
struct Lanes;

template <>
struct Lanes<double> {
    OVC_INLINE static double product_error(double a, double b, double product) {
        return std::fma(a, b, -product);
    }
    OVC_INLINE static double magnitude(double x) { return std::abs(x); }
};

/// The number hi + lo, where hi is that sum rounded to double.
template <class V>
struct DoubleDoubleOf {
    V hi;
    V lo;
};
using DoubleDouble = DoubleDoubleOf<double>;

/// Returns a + b, exactly.
template <class V>
OVC_INLINE DoubleDoubleOf<V> two_sum(V a, V b) {
    const V sum = a + b;
    const V b_share = sum - a;
    return {sum, (a - (sum - b_share)) + (b - b_share)};
}
template <class V>
OVC_INLINE DoubleDoubleOf<V> two_difference(V a, V b) {
    return two_sum(a, -b);
}
/// Returns a + b, exactly, where |a| >= |b| or a = 0.
template <class V>
OVC_INLINE DoubleDoubleOf<V> fast_two_sum(V a, V b) {
    const V sum = a + b;
    return {sum, b - (sum - a)};
}
/// Returns a b, exactly.
template <class V>
OVC_INLINE DoubleDoubleOf<V> two_product(V a, V b) {
    const V product = a * b;
    return {product, Lanes<V>::product_error(a, b, product)};
}

template <class V>
OVC_INLINE DoubleDoubleOf<V> operator-(const DoubleDoubleOf<V>& a) {
    return {-a.hi, -a.lo};
}
/// Returns the sum, off by at most 4 v^2 (|a| + |b|).
template <class V>
OVC_INLINE DoubleDoubleOf<V> operator+(const DoubleDoubleOf<V>& a, const DoubleDoubleOf<V>& b) {
    const DoubleDoubleOf<V> sum = two_sum(a.hi, b.hi);
    return fast_two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
template <class V>
OVC_INLINE DoubleDoubleOf<V> operator-(const DoubleDoubleOf<V>& a, const DoubleDoubleOf<V>& b) {
    return a + -b;
}
/// Returns the product, off by at most 4 v^2 |a b|.
template <class V>
OVC_INLINE DoubleDoubleOf<V> operator*(const DoubleDoubleOf<V>& a, V b) {
    const DoubleDoubleOf<V> product = two_product(a.hi, b);
    return fast_two_sum(product.hi, product.lo + a.lo * b);
}
/// Returns the product, off by at most 9 v^2 |a b|.
template <class V>
OVC_INLINE DoubleDoubleOf<V> operator*(const DoubleDoubleOf<V>& a, const DoubleDoubleOf<V>& b) {
    const DoubleDoubleOf<V> product = two_product(a.hi, b.hi);
    return fast_two_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

} // namespace ovc
