// SPDX-License-Identifier: Apache-2.0
// The reference where doubles leave a doubt: the same determinants, exactly.
#include "core/triangle.h"

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

ExactTriangle::ExactTriangle(const PreparedRay& p, const Triangle& triangle) {
    const ExpansionVec dir = exact_vector(scaled_direction(p));
    std::array<ExpansionVec, 3> corner;
    for (int i = 0; i < 3; ++i)
        corner[i] = exact_difference(triangle[i], p.ray.org);
    for (int i = 0; i < 3; ++i)
        weights[i] = dot(corner[(i + 1) % 3], cross(corner[(i + 2) % 3], dir));
    if (!inside())
        return;
    for (int i = 0; i < 3; ++i) {
        area = area + weights[i];
        depth = depth + weights[i] * corner[i][size_t(p.kz)];
    }
}

bool ExactTriangle::inside() const {
    bool positive = false, negative = false;
    for (const Expansion& weight : weights) {
        positive |= weight.sign() > 0;
        negative |= weight.sign() < 0;
    }
    return positive != negative;
}

int compare_t(const PreparedRay& p, const ExactTriangle& triangle, double t) {
    const Expansion reach = Expansion(t) * Expansion(p.ray.dir[p.kz]);
    const int sign = (triangle.depth - triangle.area * reach).sign();
    return sign * triangle.area.sign() * (p.ray.dir[p.kz] > 0 ? 1 : -1);
}

std::optional<Candidate> exact_candidate(const PreparedRay& p, const Triangle& triangle,
                                         TriangleId id) {
    if (!is_finite(triangle[0]) || !is_finite(triangle[1]) || !is_finite(triangle[2]))
        return std::nullopt;
    if (const RefinedAnswer refined = refined_candidate(p, triangle, id); refined.known)
        return refined.candidate;
    const ExactTriangle exact(p, triangle);
    if (!exact.inside() || compare_t(p, exact, p.ray.t_min) < 0 ||
        (std::isfinite(p.ray.t_max) && compare_t(p, exact, p.ray.t_max) > 0))
        return std::nullopt;
    const double area = exact.area.estimate();
    const double t = exact.depth.estimate() / area / p.ray.dir[p.kz];
    const double inside = std::clamp(t, p.ray.t_min, p.ray.t_max);
    uint32_t support = 0;
    for (int i = 0; i < 3; ++i)
        support |= uint32_t(exact.weights[i].sign() != 0) << i;
    return Candidate{
        {inside, exact.weights[1].estimate() / area, exact.weights[2].estimate() / area, id},
        kRefinedError * std::abs(inside),
        support};
}

/// Depth and area, both by a power of two smaller where their products might overflow.
static ExactTriangle in_reach(ExactTriangle t) {
    constexpr int kMost = 500;
    const int most =
        std::ilogb(std::max(std::abs(t.depth.estimate()), std::abs(t.area.estimate())));
    if (most > kMost) {
        t.depth = t.depth.scaled(kMost - most);
        t.area = t.area.scaled(kMost - most);
    }
    return t;
}

bool Nearest::wins_exactly(const Candidate& candidate, const Triangle& triangle) const {
    const TriangleId id = candidate.hit.id;
    if (same_support(triangle, candidate.support, triangle_, best_.support) ||
        share_axis_plane(triangle, triangle_))
        return id < best_.hit.id;
    const ExactTriangle mine = in_reach(ExactTriangle(p_, triangle_));
    const ExactTriangle other = in_reach(ExactTriangle(p_, triangle));
    // t = depth / (area dir[kz]), and dir[kz] is the same for both.
    const int sign = (other.depth * mine.area - mine.depth * other.area).sign() * mine.area.sign() *
                     other.area.sign() * (p_.ray.dir[p_.kz] > 0 ? 1 : -1);
    return sign < 0 || (sign == 0 && id < best_.hit.id);
}

} // namespace ovc
