// SPDX-License-Identifier: Apache-2.0
// ExactSolution: signs of exact determinants, and of their products.
#include "core/exact/exact_solution.h"

#include <cassert>

namespace ovc {

ExactSolution::ExactSolution(const Ray& ray, const Triangle& triangle) {
    const Vec3Of<Exact> a = exact(triangle[0]);
    s_ = solve(exact(triangle[1]) - a, exact(triangle[2]) - a, exact(ray.org) - a, exact(ray.dir));
    w_ = s_.w();
}

bool ExactSolution::inside() const {
    const int w = w_.sign(), u = s_.u.sign(), v = s_.v.sign();
    const bool positive = w > 0 || u > 0 || v > 0;
    const bool negative = w < 0 || u < 0 || v < 0;
    return positive != negative;
}

uint32_t ExactSolution::support() const {
    assert(inside());
    return uint32_t(w_.sign() != 0) | uint32_t(s_.u.sign() != 0) << 1 |
           uint32_t(s_.v.sign() != 0) << 2;
}

int ExactSolution::compare_t(double t) const {
    assert(s_.det.sign() != 0);
    return (s_.t - s_.det * Exact(t)).sign() * s_.det.sign();
}

int ExactSolution::compare_t(const ExactSolution& other) const {
    assert(s_.det.sign() != 0 && other.s_.det.sign() != 0);
    return (s_.t * other.s_.det - other.s_.t * s_.det).sign() * s_.det.sign() * other.s_.det.sign();
}

} // namespace ovc
