// SPDX-License-Identifier: Apache-2.0
// Far triangles: a few that reach through much of a scene, as those of a floor do. Rays meet them
// in doubles, by lanes, before they set out for all else.
#pragma once

#include "core/exact/triangle.h"
#include "core/lanes/ray_lanes.h"

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// Bounds hold for the exact corners; docs/design/numerics.md, "Far triangles". Points are counted
/// from corner a.
struct FarTriangle {
    double a[3];
    double normal[3]; // of length 1, apart from roundings
    double lo, hi;    // of the products of the corners with it
    /// The weight of corner b or c at a point of the plane is its product with this.
    double to_b[3], to_c[3];
    double b_size, c_size; // of these: the sums of their magnitudes
    double error;          // of a weight
    uint32_t number;
    bool shares_plane; // a, normal, lo and hi are those of the one before in a list
};

/// Returns nothing where the triangle is too thin for the bounds.
std::optional<FarTriangle> far_triangle(const Triangle& triangle, uint32_t number);

/// A triangle and its number.
struct NumberedTriangle {
    Triangle corners;
    uint32_t number;
};
/// Returns at least those for which far_triangle() returns something, in their order. Neighbours in
/// one plane, as the two of a floor, share that where they have a corner in common.
std::vector<FarTriangle> far_triangles(std::span<const NumberedTriangle> triangles);

/// What eight rays meet of some far triangles. A bit for each lane; those of rays that are not
/// valid do not matter.
struct FarMeeting {
    uint32_t hits = 0; // at least one, for certain
    /// Only exact arithmetic tells which is the nearest, or whether any is hit.
    uint32_t unclear = 0;
    uint32_t nearest[RayLanes::kCount]; // its number, where a ray hits and nothing is unclear
    /// A t that no certain hit of the ray is behind, where it has one.
    alignas(64) double last[RayLanes::kCount];
};

/// Takes rays to the triangles, between `from` and t_max. The first shares no plane. skip: the
/// number of one that each ray does not see.
FarMeeting meet_far(std::span<const FarTriangle> triangles, const RayLanes& rays,
                    const uint32_t* skip);

/// Returns the functions in the order of ways_to_look_ahead().
using MeetFar = FarMeeting (*)(std::span<const FarTriangle>, const RayLanes&, const uint32_t*);
std::vector<MeetFar> ways_to_meet_far();

} // namespace ovc
