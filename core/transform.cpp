// SPDX-License-Identifier: Apache-2.0
// Products and inverses of transforms, and how far their rounding moves a mesh.
#include "core/transform.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace ovc {

Transform then(const Transform& first, const Transform& second) {
    Transform both{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 4; ++j) {
            for (size_t k = 0; k < 3; ++k)
                both.rows[i][j] += second.rows[i][k] * first.rows[k][j];
            if (j == 3)
                both.rows[i][j] += second.rows[i][3];
        }
    return both;
}

std::optional<std::array<dvec3, 3>> inverse_matrix(const Transform& transform) {
    const auto row = [&](size_t i) {
        return dvec3(transform.rows[i][0], transform.rows[i][1], transform.rows[i][2]);
    };
    const dvec3 a = glm::cross(row(1), row(2)), b = glm::cross(row(2), row(0)),
                c = glm::cross(row(0), row(1));
    const double determinant = glm::dot(row(0), a);
    if (!(std::abs(determinant) >= 0x1p-500 && std::abs(determinant) <= 0x1p500))
        return std::nullopt;
    std::array<dvec3, 3> rows;
    for (int i = 0; i < 3; ++i)
        rows[size_t(i)] = dvec3(a[i], b[i], c[i]) / determinant;
    return rows;
}

Box placed_box(const Box& box, const Transform* transform) {
    if (!transform)
        return box;
    Box placed;
    for (int corner = 0; corner < 8; ++corner)
        placed.add((*transform)({corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y,
                                 corner & 4 ? box.hi.z : box.lo.z}));
    return placed.padded(placed.rounding());
}

bool is_well_placed(const Box& box, const Transform* transform) {
    constexpr double kFarthest = 0x1p19;    // in sizes of the mesh, with one bit to spare
    constexpr double kWithinRange = 0x1p80; // no product of three is out of range
    const auto& m = or_identity(transform).rows;
    const auto inverted = inverse_matrix(or_identity(transform));
    const double size = max_component(box.extent()) / 2;
    if (!inverted || box.empty() || !(size >= 1 / kWithinRange))
        return false;
    const dvec3 farthest = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    dvec3 reach; // bounds placed corners, and the terms of their sums
    for (int i = 0; i < 3; ++i) {
        const auto& r = m[size_t(i)];
        reach[i] = std::abs(r[0]) * farthest.x + std::abs(r[1]) * farthest.y +
                   std::abs(r[2]) * farthest.z + std::abs(r[3]);
    }
    double most = 0;
    for (const dvec3& row : *inverted)
        most = std::max(most, glm::dot(glm::abs(row), reach));
    return most <= kFarthest * size && max_component(reach) <= kWithinRange;
}

} // namespace ovc
