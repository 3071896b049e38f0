// SPDX-License-Identifier: Apache-2.0
// Exact: sums, differences and products of doubles without a rounding, whatever their exponents. It
// is the last stage of every decision about a hit, and earlier stages leave it few numbers.
#pragma once

#include "core/exact/solution.h"
#include "core/vec.h"

#include <array>
#include <cstdint>

namespace ovc {

/// A dyadic rational: sign * (limbs, lowest first) * 2^(64 * exponent). The lowest and the highest
/// limb are not zero; zero has no limbs.
class Exact {
public:
    Exact() = default;
    /// x is finite.
    Exact(double x);
    Exact(const Exact& other) { *this = other; }
    Exact& operator=(const Exact& other);

    Exact operator-() const;
    Exact operator+(const Exact& other) const { return sum(other, other.negative_); }
    Exact operator-(const Exact& other) const { return sum(other, !other.negative_); }
    Exact operator*(const Exact& other) const;

    /// -1, 0 or 1.
    int sign() const { return size_ == 0 ? 0 : negative_ ? -1 : 1; }

    /// Returns numerator / denominator (not zero), rounded once, to the nearest double, ties to
    /// even; the largest double where the quotient lies beyond it.
    static double quotient(const Exact& numerator, const Exact& denominator);

private:
    // Enough for two determinants multiplied, of corners, origin and direction that span all
    // doubles: a difference takes 34 limbs, and a determinant three times as many.
    static constexpr int kMaxLimbs = 34 * 6 + 4;

    Exact sum(const Exact& other, bool other_negative) const;
    uint64_t limb_at(int place) const {
        const unsigned i = unsigned(place - exponent_);
        return i < unsigned(size_) ? limbs_[i] : 0;
    }
    int end() const { return exponent_ + size_; }
    void complement();
    void trim();
    /// Returns the mantissa of the magnitude (not 0), which is mantissa * 2^exponent up to an error
    /// of 2^-62 of it; 0.5 <= mantissa < 1.
    double leading(int& exponent) const;

    std::array<uint64_t, kMaxLimbs> limbs_; // only the first size_ are set
    int size_ = 0;
    int exponent_ = 0;
    bool negative_ = false;
};

inline Vec3Of<Exact> exact(const dvec3& v) {
    return {v.x, v.y, v.z};
}
inline Vec3Of<Exact> operator-(const Vec3Of<Exact>& a, const Vec3Of<Exact>& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}

} // namespace ovc
