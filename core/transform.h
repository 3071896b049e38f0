// SPDX-License-Identifier: Apache-2.0
// Transform: the affine map that puts a mesh where one of its instances is.
#pragma once

#include "core/box.h"
#include "core/vec.h"

#include <array>
#include <optional>

namespace ovc {

/// Three rows of four: each row r takes a point p to ((r0 x + r1 y) + r2 z) + r3, in doubles with
/// each operation rounded. The formula is part of the ABI, and needs -ffp-contract=off.
struct Transform {
    std::array<std::array<double, 4>, 3> rows;

    dvec3 operator()(const dvec3& p) const {
        const auto along = [&](const std::array<double, 4>& r) {
            return r[0] * p.x + r[1] * p.y + r[2] * p.z + r[3];
        };
        return {along(rows[0]), along(rows[1]), along(rows[2])};
    }
};

/// Returns `first`, then `second`, as one map: their product in doubles.
Transform then(const Transform& first, const Transform& second);

inline constexpr Transform kIdentity{{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}}};

/// Returns the identity for null, which stands for a mesh that lies by itself.
inline const Transform& or_identity(const Transform* transform) {
    return transform ? *transform : kIdentity;
}

/// Returns the rows of the inverse matrix, without shift; none where doubles cannot tell it.
std::optional<std::array<dvec3, 3>> inverse_matrix(const Transform& transform);

/// Returns the way back from where the transform takes a point; none where inverse_matrix() has
/// none.
std::optional<Transform> inverse(const Transform& transform);

/// Returns the box in the world of everything that lies in `box` before it is placed, roundings
/// included. transform: null where that is in the world already.
Box placed_box(const Box& box, const Transform* transform);

/// Returns whether rounding in doubles moves placed corners, and rays that are brought to the mesh,
/// by less than 2^-30 of the mesh: 1/64 of what float32 rounds there. box: of the mesh before it is
/// placed.
bool is_well_placed(const Box& box, const Transform* transform);

/// Returns whether the same holds, by 2^-30 of `frame`, for a mesh whose corners lie in `frame` as
/// `from` placed them, where `to` places it now: rays are brought from one place to the other.
bool is_well_moved(const Transform& from, const Transform& to, const Box& frame);

} // namespace ovc
