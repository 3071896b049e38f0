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
/// Weights that are off by more say too little, and the proof wants less than 1/8.
constexpr double kMaxError = 1e-6;

void store(const dvec3& v, double (&to)[3]) {
    for (int axis = 0; axis < 3; ++axis)
        to[axis] = v[axis];
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
        const double off = kRounding * glm::dot(glm::abs(normal), glm::abs(corner));
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
    far.lo = lo;
    far.hi = hi;
    far.error = error;
    far.number = number;
    return far;
}

} // namespace ovc
