// SPDX-License-Identifier: Apache-2.0
// Transform: the affine map that puts a mesh where one of its instances is.
#pragma once

#include "core/vec.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace ovc {

/// Three rows of four: p comes to lie at ((r0 x + r1 y) + r2 z) + r3 for each row r. In doubles,
/// each operation rounded: the formula is part of the ABI, and needs -ffp-contract=off.
struct Transform {
    std::array<std::array<double, 4>, 3> rows;

    dvec3 operator()(const dvec3& p) const {
        const auto along = [&](const std::array<double, 4>& r) {
            return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
        };
        return {along(rows[0]), along(rows[1]), along(rows[2])};
    }
};

/// `first`, then `second`, as one map: their product in doubles.
inline Transform then(const Transform& first, const Transform& second) {
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

inline constexpr Transform kIdentity{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

/// null: where a mesh lies by itself.
inline const Transform& or_identity(const Transform* transform) {
    return transform ? *transform : kIdentity;
}

/// The rows of the inverse of the matrix, without its shift; none where doubles cannot tell it.
inline std::optional<std::array<dvec3, 3>> inverse_matrix(const Transform& transform) {
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

} // namespace ovc
