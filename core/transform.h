// SPDX-License-Identifier: Apache-2.0
// Transform: the affine map that puts a mesh where one of its instances is.
#pragma once

#include "core/box.h"
#include "core/vec.h"

#include <array>
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
Transform then(const Transform& first, const Transform& second);

inline constexpr Transform kIdentity{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

/// null: where a mesh lies by itself.
inline const Transform& or_identity(const Transform* transform) {
    return transform ? *transform : kIdentity;
}

/// The rows of the inverse of the matrix, without its shift; none where doubles cannot tell it.
std::optional<std::array<dvec3, 3>> inverse_matrix(const Transform& transform);

/// The box in the world of what lies in `box` before it is placed. transform: null where it is in
/// the world.
Box placed_box(const Box& box, const Transform* transform);

/// Whether what doubles round of corners that are placed, and of rays that are brought to the mesh,
/// is less than 2^-30 of the mesh: 1/64 of what float32 rounds there. box: of the mesh before it is
/// placed.
bool is_well_placed(const Box& box, const Transform* transform);

} // namespace ovc
