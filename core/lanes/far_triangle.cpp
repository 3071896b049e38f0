// SPDX-License-Identifier: Apache-2.0
// Solves for the plane and the weights of a triangle in doubles, and measures how far off they are
// at its corners.
#include "core/lanes/far_triangle.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace ovc {
namespace {

/// More than the roundings of a corner's coordinates and of their product with a vector.
constexpr double kRounding = 0x1p-49;
/// How much wider than that the bounds of a plane are, so that others in it lie within them.
constexpr double kRoomForOthers = 8;
/// Weights that are off by more say too little, and the proof wants less than 1/8.
constexpr double kMaxError = 1e-6;

void store(const dvec3& v, double (&to)[3]) {
    for (int axis = 0; axis < 3; ++axis)
        to[axis] = v[axis];
}

dvec3 point_of(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

/// Returns more than the error of the product of a plane's normal with a corner.
double rounding_of_height(const dvec3& normal, const dvec3& corner) {
    return kRounding * glm::dot(glm::abs(normal), glm::abs(corner));
}

/// Returns the triangle, with its corners counted from number i on.
Triangle from_corner(const Triangle& t, size_t i) {
    return {t[i], t[(i + 1) % 3], t[(i + 2) % 3]};
}

/// Returns the number of the first corner that the other has as well; 0: there is none.
size_t corner_in(const Triangle& t, const Triangle& other) {
    for (size_t i = 0; i < 3; ++i)
        if (std::ranges::find(other, t[i]) != other.end())
            return i;
    return 0;
}

/// Returns the triangle where its corners lie in the other's plane, and one of them is the other's
/// a.
std::optional<FarTriangle> far_triangle_in(const FarTriangle& other, const Triangle& triangle,
                                           uint32_t number) {
    const auto a = std::ranges::find(triangle, point_of(other.a));
    if (a == triangle.end())
        return std::nullopt;
    const Triangle t = from_corner(triangle, size_t(a - triangle.begin()));
    const dvec3 normal = point_of(other.normal);
    for (size_t i = 1; i < 3; ++i) {
        const dvec3 corner = t[i] - t[0];
        const double height = glm::dot(normal, corner), off = rounding_of_height(normal, corner);
        if (!(height - off >= other.lo && height + off <= other.hi))
            return std::nullopt;
    }
    std::optional<FarTriangle> far = far_triangle(t, number);
    if (!far)
        return std::nullopt;
    std::ranges::copy(other.normal, far->normal);
    far->lo = other.lo;
    far->hi = other.hi;
    far->shares_plane = true;
    return far;
}

} // namespace

std::optional<FarTriangle> far_triangle(const Triangle& triangle, uint32_t number) {
    const dvec3 ab = triangle[1] - triangle[0], ac = triangle[2] - triangle[0];
    const dvec3 across = glm::cross(ab, ac);
    const double square = glm::dot(across, across);
    const dvec3 normal = across / std::sqrt(square);
    const dvec3 to_b = glm::cross(ac, across) / square, to_c = glm::cross(across, ab) / square;
    double lo = 0, hi = 0, error = 0;
    const std::array corners{ab, ac};
    for (size_t i = 0; i < corners.size(); ++i) {
        const dvec3& corner = corners[i];
        const double height = glm::dot(normal, corner);
        const double off = kRoomForOthers * rounding_of_height(normal, corner);
        lo = std::min(lo, height - off);
        hi = std::max(hi, height + off);
        const double b = glm::dot(to_b, corner) - (i == 0), c = glm::dot(to_c, corner) - (i == 1);
        const double size = glm::dot(glm::abs(to_b) + glm::abs(to_c), glm::abs(corner)) + 1;
        const double off_at_corner = std::abs(b) + std::abs(c) + kRounding * size;
        if (!(off_at_corner <= kMaxError)) // a NaN is refused as well
            return std::nullopt;
        error = std::max(error, off_at_corner);
    }
    FarTriangle far{};
    store(triangle[0], far.a);
    store(normal, far.normal);
    store(to_b, far.to_b);
    store(to_c, far.to_c);
    far.b_size = sum_of_magnitudes(to_b);
    far.c_size = sum_of_magnitudes(to_c);
    far.lo = lo;
    far.hi = hi;
    far.error = error;
    far.number = number;
    return far;
}

std::vector<FarTriangle> far_triangles(std::span<const NumberedTriangle> triangles) {
    std::vector<FarTriangle> all;
    for (size_t i = 0; i < triangles.size(); ++i) {
        const auto& [corners, number] = triangles[i];
        const bool is_last = i + 1 == triangles.size();
        // From there on the next one may share its plane.
        const size_t common = is_last ? 0 : corner_in(corners, triangles[i + 1].corners);
        std::optional<FarTriangle> far;
        if (!all.empty())
            far = far_triangle_in(all.back(), corners, number);
        if (!far)
            far = far_triangle(from_corner(corners, common), number);
        if (!far && common != 0)
            far = far_triangle(corners, number);
        if (far)
            all.push_back(*far);
    }
    return all;
}

} // namespace ovc
