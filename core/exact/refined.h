// SPDX-License-Identifier: Apache-2.0
// Tests rays against triangles in doubled precision, where doubles leave a doubt, and computes t, u
// and v of a hit, rounded once.
#pragma once

#include "core/exact/triangle.h"
#include "core/lanes/hit_lanes.h"

namespace ovc {

/// Whether the triangle is hit, and where; known = false where only exact arithmetic can say. A
/// candidate's t is off by at most 2^-50 of itself.
struct RefinedAnswer {
    bool known = false;
    std::optional<Candidate> candidate;
};

/// Returns the answer of exact_candidate() for finite corners, where it is known.
RefinedAnswer refined_candidate(const PreparedRay& p, const Triangle& triangle, TriangleId id);
/// The same from what solve() has found for the ray and the triangle. No hit lies at an infinite t.
RefinedAnswer refined_candidate(const BoundedSolution<double>& solution, double t_min, double t_max,
                                TriangleId id);

/// Returns the hit of a lane, of which round_hits() has found what it could: t, u and v rounded
/// once. support: as in Candidate.
Hit rounded_hit(const HitLanes& lanes, int lane, TriangleId id, uint32_t support);

/// Returns the hit of a triangle that is hit, t, u and v rounded once. support: as in Candidate.
Hit rounded_hit(const PreparedRay& p, const Triangle& triangle, TriangleId id, uint32_t support);

} // namespace ovc
