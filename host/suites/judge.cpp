// SPDX-License-Identifier: Apache-2.0
// Solves for both triangles without a rounding where names differ.
#include "host/suites/judge.h"

#include "core/exact/exact_solution.h"

#include <cassert>
#include <cmath>

namespace ovc {

bool is_tied(const Ray& ray, const Triangle& named, const Triangle& right) {
    if (triangle_fault(named) != TriangleFault::None)
        return false;
    const ExactSolution solution(ray, named);
    return solution.inside() && solution.compare_t(ExactSolution(ray, right)) == 0;
}

double float_ulps(double t, double right) {
    return t == right || right == 0 ? 0 : std::ldexp(std::abs(t - right), 23 - std::ilogb(right));
}

Verdicts judge(const Soup& soup, std::span<const Ray> rays, const NamedHits& answers,
               const NamedHits& right) {
    assert(rays.size() == answers.names.size() && rays.size() == right.names.size());
    assert(rays.size() == answers.t.size() && rays.size() == right.t.size());
    Verdicts verdicts;
    for (size_t i = 0; i < rays.size(); ++i) {
        const TriangleId named = answers.names[i], is_right = right.names[i];
        if (named == is_right)
            continue;
        const bool both = soup.has(named) && soup.has(is_right);
        if (named.mesh == kNone) {
            ++verdicts.leaked;
        } else if (both && is_tied(rays[i], soup.triangle(named), soup.triangle(is_right))) {
            ++verdicts.tied;
        } else {
            ++verdicts.wrong;
            verdicts.beside += both && float_ulps(answers.t[i], right.t[i]) <= kBesideUlps;
        }
    }
    return verdicts;
}

Verdicts judge(std::span<const uint8_t> answers, std::span<const uint8_t> right) {
    assert(answers.size() == right.size());
    Verdicts verdicts;
    for (size_t i = 0; i < right.size(); ++i)
        if (bool(answers[i]) != bool(right[i]))
            ++(right[i] ? verdicts.leaked : verdicts.wrong);
    return verdicts;
}

} // namespace ovc
