// SPDX-License-Identifier: Apache-2.0
// ExactSolution: where a ray meets a triangle, without a rounding.
#pragma once

#include "core/exact/exact.h"
#include "core/exact/solution.h"
#include "core/ray.h"
#include "core/soup.h"

namespace ovc {

class ExactSolution {
public:
    /// The corners are finite, and the ray is valid.
    ExactSolution(const Ray& ray, const Triangle& triangle);

    /// Returns whether the line meets the closed triangle: no two weights have opposite signs, and
    /// not all are zero.
    bool inside() const;
    /// Returns Candidate::support (core/exact/triangle.h). This and all below need inside().
    uint32_t support() const;
    /// Returns the sign of t - `t`, which is finite.
    int compare_t(double t) const;
    /// Returns the sign of t - other's t, on the same ray.
    int compare_t(const ExactSolution& other) const;

    /// These return t, u and v, rounded once each.
    double t() const { return Exact::quotient(s_.t, s_.det); }
    double u() const { return Exact::quotient(s_.u, s_.det); }
    double v() const { return Exact::quotient(s_.v, s_.det); }

private:
    Solution<Exact> s_;
    Exact w_;
};

} // namespace ovc
