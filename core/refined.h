// SPDX-License-Identifier: Apache-2.0
// Between doubles and exact sums: a ray and a triangle in doubled precision, where only a weight
// that it cannot tell from zero is computed exactly.
#pragma once

#include "core/triangle.h"

namespace ovc {

/// Share of t that the t of a refined or exact candidate is off by at most: four roundings, and
/// half of one in each of two sums.
inline constexpr double kRefinedError = 0x1p-50;

/// Whether the triangle is hit, and where; or (known = false) that it takes exact arithmetic to
/// say: t is too near to 0, t_min or t_max, or a number is out of range.
struct RefinedAnswer {
    bool known = false;
    std::optional<Candidate> candidate;
};

/// The answer of exact_candidate() for finite corners, where it is known.
RefinedAnswer refined_candidate(const PreparedRay& p, const Triangle& triangle, TriangleId id);

/// The direction scaled by a power of two so that its largest component is about 1: weights and
/// depth scale alike, and stay away from underflow.
dvec3 scaled_direction(const PreparedRay& p);

} // namespace ovc
