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

using Matrix = std::array<dvec3, 3>; // its rows

static Matrix matrix_of(const Transform& transform) {
    Matrix matrix;
    for (size_t i = 0; i < 3; ++i)
        matrix[i] = {transform.rows[i][0], transform.rows[i][1], transform.rows[i][2]};
    return matrix;
}

/// Returns how far `inverse`, which is rounded, takes points within `reach` from where they were
/// before `matrix`, by axis.
static dvec3 way_off(const Matrix& inverse, const Matrix& matrix, const dvec3& reach) {
    dvec3 off(0);
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            double both = i == j ? -1 : 0;
            for (int k = 0; k < 3; ++k)
                both += inverse[size_t(i)][k] * matrix[size_t(k)][j];
            off[i] += std::abs(both) * reach[j];
        }
    return off;
}

std::optional<std::array<dvec3, 3>> inverse_matrix(const Transform& transform) {
    constexpr double kMaxOff = 0x1p-20;
    const Matrix matrix = matrix_of(transform);
    const dvec3 a = glm::cross(matrix[1], matrix[2]), b = glm::cross(matrix[2], matrix[0]),
                c = glm::cross(matrix[0], matrix[1]);
    const double determinant = glm::dot(matrix[0], a);
    if (!(std::abs(determinant) >= 0x1p-500 && std::abs(determinant) <= 0x1p500))
        return std::nullopt;
    Matrix inverse;
    for (int i = 0; i < 3; ++i)
        inverse[size_t(i)] = dvec3(a[i], b[i], c[i]) / determinant;
    // The determinant of a singular matrix may be nothing but roundings.
    if (!(max_component(way_off(inverse, matrix, dvec3(1))) <= kMaxOff))
        return std::nullopt;
    return inverse;
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

constexpr double kFarthest = 0x1p19;     // in sizes of the mesh, with one bit to spare
constexpr double kFarthestOff = 0x1p-31; // likewise: an inverse, which is rounded too
constexpr double kWithinRange = 0x1p80;  // no product of three is out of range

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
dvec3 reach_of(const Matrix& matrix, const dvec3& reach) {
    dvec3 all;
    for (int i = 0; i < 3; ++i)
        all[i] = glm::dot(glm::abs(matrix[size_t(i)]), reach);
    return all;
}

} // namespace

bool is_well_placed(const Box& box, const Transform* transform) {
    const Transform& place = or_identity(transform);
    const auto inverted = inverse_matrix(place);
    const double size = max_component(box.extent()) / 2;
    if (!inverted || box.empty() || !(size >= 1 / kWithinRange))
        return false;
    const dvec3 farthest = glm::max(glm::abs(box.lo), glm::abs(box.hi));
    const dvec3 reach = reach_of(place, farthest);
    const dvec3 off = way_off(*inverted, matrix_of(place), farthest);
    return max_component(reach_of(*inverted, reach)) <= kFarthest * size &&
           max_component(off) <= kFarthestOff * size && max_component(reach) <= kWithinRange;
}

bool is_well_moved(const Transform& from, const Transform& to, const Box& frame) {
    // Four roundings add up: those of both places of a corner, of the product and of its inverse.
    constexpr double kEach = kFarthest / 4;
    const auto back = inverse(from);
    const double size = max_component(frame.extent()) / 2;
    if (!back || !(size >= 1 / kWithinRange))
        return false;
    const Transform moved = then(*back, to);
    const auto inverted = inverse_matrix(moved);
    if (!inverted)
        return false;
    // From the frame to the mesh, and from there to where it is now. The terms of the way back
    // cancel out, so it is gone twice.
    const dvec3 shift(std::abs(from.rows[0][3]), std::abs(from.rows[1][3]),
                      std::abs(from.rows[2][3]));
    const Matrix to_mesh = matrix_of(*back), to_frame = matrix_of(from);
    const dvec3 farthest = glm::max(glm::abs(frame.lo), glm::abs(frame.hi));
    const dvec3 mesh = reach_of(to_mesh, farthest + shift);
    const dvec3 placed = reach_of(from, mesh);
    const dvec3 now = reach_of(to, reach_of(to_mesh, placed + shift));
    const dvec3 off = way_off(*inverted, matrix_of(moved), farthest) +
                      reach_of(to_frame, way_off(to_mesh, to_frame, mesh));
    return max_component(placed) <= kEach * size &&
           max_component(reach_of(*inverted, now)) <= kEach * size &&
           max_component(off) <= kFarthestOff * size && max_component(now) <= kWithinRange;
}

} // namespace ovc
