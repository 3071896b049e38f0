// SPDX-License-Identifier: Apache-2.0
// Expansion: exact sums and products of doubles, as sums of doubles that do not overlap.
// Based on: Shewchuk 1997, "Adaptive Precision Floating-Point Arithmetic and Fast Robust Geometric
// Predicates", sections 2.2-2.6; Dekker 1971. Exact as long as nothing over- or underflows:
// products must stay within about 1e-290 … 1e300.
#pragma once

#include "core/double_double.h"
#include "core/vec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace ovc {

/// A number that a double cannot hold. No components: zero.
class Expansion {
public:
    Expansion() {}
    Expansion(double x) { add(x); }
    Expansion(const Expansion& other) { *this = other; }
    Expansion& operator=(const Expansion& other) {
        // Only what counts: most have a handful of components.
        std::copy_n(other.components_.begin(), other.size_, components_.begin());
        size_ = other.size_;
        return *this;
    }
    /// a - b, exactly.
    static Expansion difference(double a, double b) {
        Expansion e(a);
        e.add(-b);
        return e;
    }

    Expansion operator-() const {
        Expansion negative = *this;
        for (int i = 0; i < size_; ++i)
            negative.components_[i] = -components_[i];
        return negative;
    }
    Expansion operator+(const Expansion& other) const {
        Expansion total = *this;
        for (int i = 0; i < other.size_; ++i)
            total.add(other.components_[i]);
        return total;
    }
    Expansion operator-(const Expansion& other) const { return *this + -other; }
    Expansion operator*(const Expansion& other) const {
        Expansion total;
        for (int i = 0; i < size_; ++i)
            for (int k = 0; k < other.size_; ++k) {
                const double product = components_[i] * other.components_[k];
                total.add(std::fma(components_[i], other.components_[k], -product));
                total.add(product);
            }
        total.compress();
        return total;
    }

    /// 2^exponent times this, exactly as long as no component comes below 2^-1022.
    Expansion scaled(int exponent) const {
        Expansion result = *this;
        for (int i = 0; i < size_; ++i)
            result.components_[i] = std::ldexp(components_[i], exponent);
        return result;
    }

    /// -1, 0 or 1. The last component outweighs all others.
    int sign() const {
        if (size_ == 0)
            return 0;
        return components_[size_ - 1] > 0 ? 1 : -1;
    }
    /// Off by less than two units in the last place.
    double estimate() const {
        double total = 0;
        for (int i = 0; i < size_; ++i) // smallest first
            total += components_[i];
        return total;
    }

    /// Off by at most 2^-96 of itself.
    DoubleDouble rounded() const {
        DoubleDouble total;
        for (int i = 0; i < size_; ++i)
            total = total + DoubleDouble{components_[i], 0};
        return total;
    }

private:
    // Compressed, components are 53 bits apart, and doubles span 2,100 bits.
    static constexpr int kCapacity = 64;

    /// Grow-Expansion with zero elimination (Shewchuk 1997, figure 6).
    void add(double b) {
        if (size_ == kCapacity)
            compress();
        if (size_ == kCapacity) { // something was not finite
            components_[0] = std::numeric_limits<double>::quiet_NaN();
            size_ = 1;
            return;
        }
        int kept = 0;
        for (int i = 0; i < size_; ++i) {
            const double c = components_[i];
            const double s = b + c;
            const double virtual_c = s - b;
            const double error = (b - (s - virtual_c)) + (c - virtual_c);
            if (error != 0)
                components_[kept++] = error;
            b = s;
        }
        if (b != 0)
            components_[kept++] = b;
        size_ = kept;
    }

    /// The same number in as few components as it takes (Shewchuk 1997, figure 15).
    void compress() {
        if (size_ < 2)
            return;
        int bottom = size_ - 1;
        double q = components_[bottom];
        for (int i = bottom; i-- > 0;) {
            const double s = q + components_[i];
            const double rest = components_[i] - (s - q);
            q = s;
            if (rest != 0) {
                components_[bottom--] = q;
                q = rest;
            }
        }
        components_[bottom] = q;
        int top = 0;
        for (int i = bottom + 1; i < size_; ++i) {
            const double s = components_[i] + q;
            const double rest = q - (s - components_[i]);
            q = s;
            if (rest != 0)
                components_[top++] = rest;
        }
        components_[top] = q;
        size_ = top + 1;
    }

    std::array<double, kCapacity> components_; // growing magnitude, not overlapping, none zero
    int size_ = 0;
};

using ExpansionVec = std::array<Expansion, 3>;

inline ExpansionVec exact_difference(const dvec3& a, const dvec3& b) {
    return {Expansion::difference(a.x, b.x), Expansion::difference(a.y, b.y),
            Expansion::difference(a.z, b.z)};
}
inline ExpansionVec exact_vector(const dvec3& v) {
    return {v.x, v.y, v.z};
}

inline Expansion dot(const ExpansionVec& a, const ExpansionVec& b) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline ExpansionVec cross(const ExpansionVec& a, const ExpansionVec& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

} // namespace ovc
