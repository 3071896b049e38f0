// SPDX-License-Identifier: Apache-2.0
// Where a ray meets a triangle, without a rounding.
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

    /// Whether the line meets the closed triangle: no two weights have opposite signs, and not all
    /// are zero.
    bool inside() const;
    /// As in Candidate (core/exact/triangle.h). Needs inside(), as all below.
    uint32_t support() const;
    /// The sign of t - `t`, which is finite.
    int compare_t(double t) const;
    /// The sign of t - other's t, on the same ray.
    int compare_t(const ExactSolution& other) const;

    /// Rounded once each.
    double t() const { return Exact::quotient(s_.t, s_.det); }
    double u() const { return Exact::quotient(s_.u, s_.det); }
    double v() const { return Exact::quotient(s_.v, s_.det); }

private:
    Solution<Exact> s_;
    Exact w_;
};

} // namespace ovc
