// SPDX-License-Identifier: Apache-2.0
// DoubleDouble: a sum of two doubles, about 106 bits. Based on: Dekker 1971, "A Floating-Point
// Technique for Extending the Available Precision"; error bounds as in Joldes, Muller and Popescu
// 2017, with simpler constants. v is 2^-53; all bounds hold as long as nothing overflows, but for
// 2^-1074 where a product underflows.
#pragma once

#include "core/vec.h"

#include <array>
#include <cmath>

namespace ovc {

/// hi + lo, where hi is that sum rounded to double.
struct DoubleDouble {
    double hi = 0;
    double lo = 0;

    bool operator==(const DoubleDouble&) const = default;
};

/// a + b, exactly.
inline DoubleDouble two_sum(double a, double b) {
    const double sum = a + b;
    const double b_share = sum - a;
    return {sum, (a - (sum - b_share)) + (b - b_share)};
}
inline DoubleDouble two_difference(double a, double b) {
    return two_sum(a, -b);
}
/// a b, exactly.
inline DoubleDouble two_product(double a, double b) {
    const double product = a * b;
    return {product, std::fma(a, b, -product)};
}

inline DoubleDouble operator-(const DoubleDouble& a) {
    return {-a.hi, -a.lo};
}
/// Off by at most 4 v^2 (|a| + |b|).
inline DoubleDouble operator+(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble sum = two_sum(a.hi, b.hi);
    return two_sum(sum.hi, sum.lo + (a.lo + b.lo));
}
inline DoubleDouble operator-(const DoubleDouble& a, const DoubleDouble& b) {
    return a + -b;
}
/// Off by at most 4 v^2 |a b|.
inline DoubleDouble operator*(const DoubleDouble& a, double b) {
    const DoubleDouble product = two_product(a.hi, b);
    return two_sum(product.hi, product.lo + a.lo * b);
}
/// Off by at most 9 v^2 |a b|.
inline DoubleDouble operator*(const DoubleDouble& a, const DoubleDouble& b) {
    const DoubleDouble product = two_product(a.hi, b.hi);
    return two_sum(product.hi, product.lo + (a.hi * b.lo + a.lo * b.hi));
}

using DoubleDoubleVec = std::array<DoubleDouble, 3>;

/// a - b, exactly.
inline DoubleDoubleVec two_difference(const dvec3& a, const dvec3& b) {
    return {two_difference(a.x, b.x), two_difference(a.y, b.y), two_difference(a.z, b.z)};
}
/// Each component off by at most 9 v^2 times the sum of the magnitudes of its two products.
inline DoubleDoubleVec cross(const DoubleDoubleVec& a, const dvec3& b) {
    return {a[1] * b.z - a[2] * b.y, a[2] * b.x - a[0] * b.z, a[0] * b.y - a[1] * b.x};
}
/// Off by at most 18 v^2 times the sum of the magnitudes of its products.
inline DoubleDouble dot(const DoubleDoubleVec& a, const DoubleDoubleVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

} // namespace ovc
