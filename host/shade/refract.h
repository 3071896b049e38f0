// SPDX-License-Identifier: Apache-2.0
// Snell's law in double, without the cancellation of the textbook's formula. The derivation is in
// docs/design/numerics.md, "Refraction".
#pragma once

#include "core/vec.h"

#include <cmath>
#include <optional>

namespace ovc {

/// Returns the direction of light that crosses from a medium of index `from` into one of index
/// `to`; nothing where all of it is reflected, from the critical angle on. It keeps the length of
/// dir, and dir itself bit for bit where from == to == 1.
/// normal: unit length, dot(dir, normal) <= 0. dir: of length 1e-100 to 1e100. from, to: 1e-6 to
/// 1e6.
/// Based on: Whitted 1980, section 2, in the vector form of Glassner 1989, "An Introduction to Ray
/// Tracing", chapter 4, section 3.
inline std::optional<dvec3> refracted(const dvec3& dir, const dvec3& normal, double from,
                                      double to) {
    const double across = -from * glm::dot(dir, normal);
    // to^2 - from^2 as a product: the differences of indices near 1 are exact (Sterbenz).
    const double step = (to - from) * (to + from) * glm::dot(dir, dir);
    const double square = step + across * across;
    if (!(square > 0))
        return std::nullopt;
    // The textbook's sqrt(square) - across, which is 0 to rounding for like indices.
    const double turn = step / (across + std::sqrt(square));
    return (from * dir - turn * normal) / to;
}

} // namespace ovc
