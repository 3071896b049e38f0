// SPDX-License-Identifier: Apache-2.0
// Polynomials of x, y and z, and bounds on them.
#pragma once

#include "core/box.h"

#include <vector>

namespace ovc::pov {

/// POV-Ray's largest.
inline constexpr int kMaxOrder = 35;

struct Range {
    double lo, hi;
};

struct Polynomial {
    struct Term {
        double factor;
        int powers[3]; // up to kMaxOrder
    };
    std::vector<Term> terms;
    int highest = 0; // power of a coordinate

    void add(const Term& term);
    double operator()(const dvec3& p) const;
    /// Returns bounds on the values in the box.
    Range range_over(const Box& box) const;
};

/// Returns the polynomial with factors_of(order) factors, whose terms are in POV-Ray's order: by
/// falling powers of x, then y, then z.
Polynomial polynomial_of(int order, const std::vector<double>& factors);
/// Returns how many terms a polynomial of this order has.
size_t factors_of(int order);

/// Returns a part of the box that contains all its points where the polynomial is not above 0, or
/// an empty box.
Box tightened(const Polynomial& polynomial, const Box& box);

} // namespace ovc::pov
