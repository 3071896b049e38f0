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

std::optional<Transform> inverse(const Transform& transform) {
    const auto matrix = inverse_matrix(transform);
    if (!matrix)
        return std::nullopt;
    const auto& m = transform.rows;
    Transform back{};
    for (size_t i = 0; i < 3; ++i) {
        const dvec3& row = (*matrix)[i];
        back.rows[i] = {row.x, row.y, row.z,
                        -(row.x * m[0][3] + row.y * m[1][3] + row.z * m[2][3])};
    }
    return back;
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

namespace {

constexpr double kFarthest = 0x1p19;    // in sizes of the mesh, with one bit to spare
constexpr double kWithinRange = 0x1p80; // no product of three is out of range

/// Returns a bound of what the transform makes of points within `reach`, and of all terms of the
/// sums.
dvec3 reach_of(const Transform& transform, const dvec3& reach) {
    dvec3 all;
    for (int i = 0; i < 3; ++i) {
        const auto& r = transform.rows[size_t(i)];
        all[i] = std::abs(r[0]) * reach.x + std::abs(r[1]) * reach.y + std::abs(r[2]) * reach.z +
                 std::abs(r[3]);
    }
    return all;
}

/// Returns the same for a matrix.
double reach_of(const std::array<dvec3, 3>& matrix, const dvec3& reach) {
    double most = 0;
    for (const dvec3& row : matrix)
        most = std::max(most, glm::dot(glm::abs(row), reach));
    return most;
}

} // namespace

bool is_well_placed(const Box& box, const Transform* transform) {
    const auto inverted = inverse_matrix(or_identity(transform));
    const double size = max_component(box.extent()) / 2;
    if (!inverted || box.empty() || !(size >= 1 / kWithinRange))
        return false;
    const dvec3 farthest = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    const dvec3 reach = reach_of(or_identity(transform), farthest);
    return reach_of(*inverted, reach) <= kFarthest * size && max_component(reach) <= kWithinRange;
}

bool is_well_moved(const Transform& from, const Transform& to, const Box& frame) {
    // Four roundings add up: those of both places of a corner, of the product and of its inverse.
    constexpr double kEach = kFarthest / 4;
    const auto back = inverse(from);
    const double size = max_component(frame.extent()) / 2;
    if (!back || !(size >= 1 / kWithinRange))
        return false;
    const auto inverted = inverse_matrix(then(*back, to));
    if (!inverted)
        return false;
    // From the frame to the mesh, and from there to where it is now. The terms of the way back
    // cancel out, so it is gone twice.
    const dvec3 shift(std::abs(from.rows[0][3]), std::abs(from.rows[1][3]),
                      std::abs(from.rows[2][3]));
    const Transform to_mesh{{{{back->rows[0][0], back->rows[0][1], back->rows[0][2], 0},
                              {back->rows[1][0], back->rows[1][1], back->rows[1][2], 0},
                              {back->rows[2][0], back->rows[2][1], back->rows[2][2], 0}}}};
    const dvec3 farthest = glm::max(glm::abs(frame.lo), glm::abs(frame.hi));
    const dvec3 placed = reach_of(from, reach_of(to_mesh, farthest + shift));
    const dvec3 now = reach_of(to, reach_of(to_mesh, placed + shift));
    return max_component(placed) <= kEach * size && reach_of(*inverted, now) <= kEach * size &&
           max_component(now) <= kWithinRange;
}

} // namespace ovc
