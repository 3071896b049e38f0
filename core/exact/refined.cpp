// SPDX-License-Identifier: Apache-2.0
// The bounds are derived in docs/design/numerics.md, "The reference".
#include "core/exact/refined.h"

#include "core/exact/exact_solution.h"

#include <cassert>

namespace ovc {
namespace {

BoundedSolution<double> solution_of(const PreparedRay& p, const Triangle& triangle) {
    MeetingLanes lanes{};
    lanes.set(0, &p.ray, triangle);
    SolutionLanes solutions;
    solve(lanes, 1, solutions);
    return solutions.at(0);
}

/// Returns -1 or 1; 0 where the sign is not known, or the value is exactly 0.
int sign_of(const DoubleDouble& value, double error) {
    return value.hi > error ? 1 : value.hi < -error ? -1 : 0;
}

/// Returns the sign of the quotient minus x; 0 where its error leaves it open.
int compare(const Quotient<double>& quotient, double x) {
    // The difference of neighbouring doubles is exact, and the rounding of others does not matter.
    const double gap = (quotient.value.hi - x) + quotient.value.lo;
    const double error = quotient.error + 0x1p-51 * std::abs(quotient.value.lo);
    return gap > error ? 1 : gap < -error ? -1 : 0;
}

Quotient<double> over_det(const BoundedSolution<double>& s, const DoubleDouble& value,
                          double error) {
    return quotient(value, error, s.value.det, s.error.det, 1 / s.value.det.hi);
}

} // namespace

RefinedAnswer refined_candidate(const PreparedRay& p, const Triangle& triangle, TriangleId id) {
    return refined_candidate(solution_of(p, triangle), p.ray.t_min, p.ray.t_max, id);
}

RefinedAnswer refined_candidate(const BoundedSolution<double>& s, double t_min, double t_max,
                                TriangleId id) {
    const int w = sign_of(s.w(), s.w_error());
    const int u = sign_of(s.value.u, s.error.u);
    const int v = sign_of(s.value.v, s.error.v);
    const bool positive = w > 0 || u > 0 || v > 0;
    const bool negative = w < 0 || u < 0 || v < 0;
    if (positive && negative)
        return {true, std::nullopt};
    if (w == 0 || u == 0 || v == 0)
        return {};
    const Quotient<double> t = over_det(s, s.value.t, s.error.t);
    const int behind = compare(t, t_min), beyond = compare(t, t_max);
    if (behind < 0 || beyond > 0)
        return {true, std::nullopt};
    const double hi = t.value.hi;
    if (behind == 0 || beyond == 0 || !(t.error <= 0x1p-50 * std::abs(hi)))
        return {};
    const double inverse = 1 / s.value.det.hi;
    const Hit about{hi, s.value.u.hi * inverse, s.value.v.hi * inverse, id};
    return {true, Candidate{about, t.value.lo, t.error, Candidate::kAllCorners, true}};
}

Hit rounded_hit(const HitLanes& lanes, int lane, TriangleId id, uint32_t support) {
    assert(support > 0 && support <= Candidate::kAllCorners);
    const bool at_a = support == 1, no_u = at_a || !(support & 2), no_v = at_a || !(support & 4);
    const long long known =
        lanes.known[lane] | (no_u ? HitLanes::kU : 0) | (no_v ? HitLanes::kV : 0);
    if (known == HitLanes::kAll)
        return {lanes.t[lane], no_u ? 0 : lanes.u[lane], no_v ? 0 : lanes.v[lane], id};
    const ExactSolution exact(lanes.ray(lane), lanes.triangle(lane));
    return {exact.t(), exact.u(), exact.v(), id};
}

Hit rounded_hit(const PreparedRay& p, const Triangle& triangle, TriangleId id, uint32_t support) {
    HitLanes lanes{};
    lanes.set(0, &p.ray, triangle);
    round_hits(lanes, 1);
    return rounded_hit(lanes, 0, id, support);
}

} // namespace ovc
