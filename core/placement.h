// SPDX-License-Identifier: Apache-2.0
// Placement: the affine map that puts a mesh where one of its instances is.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstddef>

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

} // namespace ovc
