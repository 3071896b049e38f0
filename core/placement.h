// SPDX-License-Identifier: Apache-2.0
// Placement: the affine map that puts a mesh where one of its instances is.
#pragma once

#include "core/vec.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <optional>

namespace ovc {

/// Three rows of four: p comes to lie at ((r0 x + r1 y) + r2 z) + r3 for each row r. In doubles,
/// each operation rounded: the formula is part of the ABI, and needs -ffp-contract=off.
struct Placement {
    std::array<std::array<double, 4>, 3> rows;

    dvec3 operator()(const dvec3& p) const {
        const auto along = [&](const std::array<double, 4>& r) {
            return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
        };
        return {along(rows[0]), along(rows[1]), along(rows[2])};
    }
};

/// `first`, then `second`, as one map: their product in doubles.
inline Placement then(const Placement& first, const Placement& second) {
    Placement both{};
    for (size_t i = 0; i < 3; ++i)
        for (size_t j = 0; j < 4; ++j) {
            for (size_t k = 0; k < 3; ++k)
                both.rows[i][j] += second.rows[i][k] * first.rows[k][j];
            if (j == 3)
                both.rows[i][j] += second.rows[i][3];
        }
    return both;
}

inline constexpr Placement kUnplaced{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

/// null: where a mesh lies by itself.
inline const Placement& or_unplaced(const Placement* placement) {
    return placement ? *placement : kUnplaced;
}

/// The rows of the inverse of the matrix, without its shift; none where doubles cannot tell it.
inline std::optional<std::array<dvec3, 3>> inverse_matrix(const Placement& placement) {
    const auto row = [&](size_t i) {
        return dvec3(placement.rows[i][0], placement.rows[i][1], placement.rows[i][2]);
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
