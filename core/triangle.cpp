// SPDX-License-Identifier: Apache-2.0
// The reference where doubles leave a doubt: the same determinants, exactly.
#include "core/triangle.h"

namespace ovc {
namespace {

/// The direction scaled by a power of two to about 1: weights and depth scale alike, and stay away
/// from underflow.
dvec3 scaled_direction(const PreparedRay& p) {
    int exponent = 0;
    std::frexp(p.ray.dir[p.kz], &exponent);
    return {std::ldexp(p.ray.dir.x, -exponent), std::ldexp(p.ray.dir.y, -exponent),
            std::ldexp(p.ray.dir.z, -exponent)};
}

/// Do both have the same three corners, in whatever order? Then no ray tells them apart.
bool same_corners(const Triangle& a, const Triangle& b) {
    for (int turn = 0; turn < 3; ++turn) {
        const dvec3& first = b[turn];
        const dvec3& second = b[(turn + 1) % 3];
        const dvec3& third = b[(turn + 2) % 3];
        if (a[0] == first &&
            ((a[1] == second && a[2] == third) || (a[1] == third && a[2] == second)))
            return true;
    }
    return false;
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
    const ExactTriangle exact(p, triangle);
    if (!exact.inside() || compare_t(p, exact, p.ray.t_min) < 0 ||
        (std::isfinite(p.ray.t_max) && compare_t(p, exact, p.ray.t_max) > 0))
        return std::nullopt;
    const double area = exact.area.estimate();
    const double t = exact.depth.estimate() / area / p.ray.dir[p.kz];
    const double inside = std::clamp(t, p.ray.t_min, p.ray.t_max);
    return Candidate{
        {inside, exact.weights[1].estimate() / area, exact.weights[2].estimate() / area, id},
        0x1p-50 * std::abs(inside)};
}

bool Nearest::wins_exactly(TriangleId id, const Triangle& triangle) const {
    if (same_corners(triangle, triangle_) || share_axis_plane(triangle, triangle_))
        return id < best_.hit.id;
    const ExactTriangle mine(p_, triangle_);
    const ExactTriangle other(p_, triangle);
    // t = depth / (area dir[kz]), and dir[kz] is the same for both.
    const int sign = (other.depth * mine.area - mine.depth * other.area).sign() * mine.area.sign() *
                     other.area.sign() * (p_.ray.dir[p_.kz] > 0 ? 1 : -1);
    return sign < 0 || (sign == 0 && id < best_.hit.id);
}

} // namespace ovc
