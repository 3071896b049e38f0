// SPDX-License-Identifier: Apache-2.0
// Solves for both triangles without a rounding where names differ.
#include "host/bench/judge.h"

#include "core/exact/exact_solution.h"

#include <cassert>

namespace ovc {

/// Returns whether the ray meets the triangle at the t of its hit of the other one.
static bool is_tied(const Ray& ray, const Triangle& named, const Triangle& right) {
    if (triangle_fault(named) != TriangleFault::None)
        return false;
    const ExactSolution solution(ray, named);
    return solution.inside() && solution.compare_t(ExactSolution(ray, right)) == 0;
}

Verdicts judge(const Soup& soup, std::span<const Ray> rays, std::span<const TriangleId> answers,
               std::span<const TriangleId> right) {
    assert(rays.size() == answers.size() && rays.size() == right.size());
    Verdicts verdicts;
    for (size_t i = 0; i < rays.size(); ++i) {
        if (answers[i] == right[i])
            continue;
        if (answers[i].mesh == kNone)
            ++verdicts.leaked;
        else if (soup.has(right[i]) && soup.has(answers[i]) &&
                 is_tied(rays[i], soup.triangle(answers[i]), soup.triangle(right[i])))
            ++verdicts.tied;
        else
            ++verdicts.wrong;
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
