// SPDX-License-Identifier: Apache-2.0
// Polynomials of x, y and z, and bounds on them.
#pragma once

#include "core/box.h"

#include <vector>

namespace ovc::pov {

struct Polynomial {
    struct Term {
        double factor;
        int powers[3];
    };
    std::vector<Term> terms;

    double operator()(const dvec3& p) const;
    /// No value in the box is below this.
    double least(const Box& box) const;
};

/// The terms in POV-Ray's order: by falling powers of x, then y, then z.
Polynomial polynomial_of(int order, const std::vector<double>& factors);
/// How many factors that takes.
size_t factors_of(int order);

/// A box, no larger than this one, outside of which within this one the polynomial is above 0.
Box tightened(const Polynomial& polynomial, const Box& box);

} // namespace ovc::pov
