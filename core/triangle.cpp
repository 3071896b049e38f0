// SPDX-License-Identifier: Apache-2.0
// The reference where doubles leave a doubt: the same determinants, exactly.
#include "core/triangle.h"

#include "core/exact_solution.h"
#include "core/refined.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace ovc {
namespace {

/// Do the corners of `b` that `b_support` names lie where those of `a` do? Then the ray meets both
/// in one point: a shared corner, a shared side, or a triangle with the same three corners.
bool same_support(const Triangle& a, uint32_t a_support, const Triangle& b, uint32_t b_support) {
    if (std::popcount(a_support) != std::popcount(b_support))
        return false;
    for (int i = 0; i < 3; ++i) {
        bool found = !(a_support >> i & 1);
        for (int k = 0; k < 3; ++k)
            found |= (b_support >> k & 1) && a[i] == b[k];
        if (!found)
            return false;
    }
    return true;
}

/// Do both lie in one plane across an axis? Walls and floors do.
bool share_axis_plane(const Triangle& a, const Triangle& b) {
    for (int axis = 0; axis < 3; ++axis) {
        const double at = a[0][axis];
        if (a[1][axis] == at && a[2][axis] == at && b[0][axis] == at && b[1][axis] == at &&
            b[2][axis] == at)
            return true;
    }
    return false;
}

} // namespace

std::optional<Candidate> exact_candidate(const PreparedRay& p, const Triangle& triangle,
                                         TriangleId id) {
    if (!is_finite(triangle[0]) || !is_finite(triangle[1]) || !is_finite(triangle[2]))
        return std::nullopt;
    if (const RefinedAnswer refined = refined_candidate(p, triangle, id); refined.known)
        return refined.candidate;
    const ExactSolution exact(p, triangle);
    if (!exact.inside() || exact.compare_t(p.ray.t_min) < 0 || exact.compare_t(p.ray.t_max) > 0)
        return std::nullopt;
    const double t = exact.t();
    return Candidate{
        {t, exact.u(), exact.v(), id}, 0, 0x1p-53 * std::abs(t) + 0x1p-1074, exact.support()};
}

/// The order of two hits that doubles leave open.
bool Nearest::wins_closely(Candidate other, const Triangle& triangle) {
    const TriangleId id = other.hit.id;
    if (same_support(triangle, other.support, triangle_, best_.support) ||
        share_axis_plane(triangle, triangle_))
        return id < best_.hit.id;
    const auto refine = [&](Candidate& candidate, const Triangle& of) {
        if (const RefinedAnswer better = refined_candidate(p_, of, candidate.hit.id);
            better.candidate)
            candidate = *better.candidate;
    };
    refine(best_, triangle_);
    refine(other, triangle);
    int order = other.compare_t(best_);
    if (order == 0)
        order = ExactSolution(p_, triangle).compare_t(ExactSolution(p_, triangle_));
    return order != 0 ? order < 0 : id < best_.hit.id;
}

Hit Nearest::hit() const {
    return is_hit() ? rounded_hit(p_, triangle_, best_.hit.id, best_.support) : Hit{};
}

std::optional<Hit> intersect(const PreparedRay& p, const Triangle& triangle, TriangleId id) {
    const std::optional<Candidate> found = candidate(p, triangle, id);
    if (!found)
        return std::nullopt;
    return rounded_hit(p, triangle, id, found->support);
}

} // namespace ovc
