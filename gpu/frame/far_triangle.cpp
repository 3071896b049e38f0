// SPDX-License-Identifier: Apache-2.0
// Solves for the plane and the weights of a triangle in doubles, and measures how far off they are
// at its corners.
#include "gpu/frame/far_triangle.h"

#include "shaders/layout.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace ovc {
namespace {

/// The kernel tests one after the other; above this a tree of float32 boxes is faster.
constexpr size_t kMaxTriangles = OVC_MAX_FAR_TRIANGLES;
/// A leaf reaches far if it is at least this part of the scene.
constexpr double kMinReach = 1.0 / 4;
/// More than the roundings of a corner's coordinates and of their product with a vector.
constexpr double kRounding = 0x1p-49;
/// Weights that are off by more say too little, and the proof wants less than 1/8.
constexpr double kMaxError = 1e-6;

std::optional<FarTriangle> far_triangle(const Triangle& t, uint32_t number) {
    const dvec3 ab = t[1] - t[0], ac = t[2] - t[0];
    const dvec3 across = glm::cross(ab, ac);
    const double square = glm::dot(across, across);
    FarTriangle far{.normal = across / std::sqrt(square), .number = number};
    const dvec3 to_b = glm::cross(ac, across) / square, to_c = glm::cross(across, ab) / square;
    far.corners[1] = {to_b, glm::dot(to_b, t[0])};
    far.corners[2] = {to_c, glm::dot(to_c, t[0])};
    far.corners[0] = {-(to_b + to_c), -(1 + far.corners[1].shift + far.corners[2].shift)};
    far.lo = HUGE_VAL;
    far.hi = -HUGE_VAL;
    for (size_t at = 0; at < 3; ++at) {
        const double height = glm::dot(far.normal, t[at]);
        const double off = kRounding * glm::dot(glm::abs(far.normal), glm::abs(t[at]));
        far.lo = std::min(far.lo, height - off);
        far.hi = std::max(far.hi, height + off);
        for (size_t i = 0; i < 3; ++i) {
            const FarTriangle::Corner& corner = far.corners[i];
            const double size =
                glm::dot(glm::abs(corner.to_weight), glm::abs(t[at])) + std::abs(corner.shift);
            far.error = std::max(far.error,
                                 std::abs(corner.weight_at(t[at]) - (i == at)) + kRounding * size);
        }
    }
    // Written so that a NaN is refused as well.
    return far.error <= kMaxError && std::isfinite(far.hi - far.lo) ? std::optional(far)
                                                                    : std::nullopt;
}

} // namespace

std::array<double, 18> FarTriangle::numbers() const {
    std::array<double, 18> all{normal.x, normal.y, normal.z, lo, hi};
    auto next = all.begin() + 5;
    for (const Corner& corner : corners)
        for (const double each :
             {corner.to_weight.x, corner.to_weight.y, corner.to_weight.z, corner.shift})
            *next++ = each;
    *next = error;
    return all;
}

std::vector<FarTriangle> far_triangles_of(const NumberedSoup& numbered, const Leaf& leaf,
                                          const Box& scene) {
    if (leaf.list().size() > kMaxTriangles ||
        max_component(leaf.box.extent()) < kMinReach * max_component(scene.extent()))
        return {};
    std::vector<FarTriangle> far;
    for (const TriangleId id : leaf.list()) {
        Triangle local = numbered.soup.triangle(id);
        for (dvec3& corner : local)
            corner = leaf.frame.to_local(corner);
        const auto triangle = far_triangle(local, numbered.numbers.of(id));
        if (!triangle)
            return {};
        far.push_back(*triangle);
    }
    return far;
}

} // namespace ovc
