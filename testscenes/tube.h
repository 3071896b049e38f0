// SPDX-License-Identifier: Apache-2.0
// Tubes: closed surfaces of rings between two poles, with any given number of triangles.
#pragma once

#include "testscenes/corners.h"

#include <cstdint>
#include <functional>

namespace ovc {

/// Triangles that a generator makes. normals: 3 for each triangle, or empty if none are wanted.
struct Surface {
    Corners corners;
    std::vector<vec3> normals;
};

/// The division of a tube into `along` rings of `around` points. The first `crossed` quads between
/// rings are four triangles around their middle, all others two.
struct TubeGrid {
    uint32_t around = 3, along = 2;
    uint64_t crossed = 0;

    uint64_t triangles() const { return 2 * (uint64_t(around) * along + crossed); }
};

/// tube_grid() takes at least so many triangles.
inline constexpr uint64_t kMinTubeTriangles = 12;

/// Returns a grid of exactly `triangles`, which are even and at least kMinTubeTriangles, with about
/// `rings_per_point` rings for each point of a ring.
TubeGrid tube_grid(uint64_t triangles, double rings_per_point);

/// Returns the place of a tube's point. Rings 0 and `along` + 1 are the poles. Turns go from 0 to 1
/// around a ring, counterclockwise seen from the end of the tube.
using TubeShape = std::function<dvec3(uint32_t ring, double turns)>;

/// Appends the tube. Several threads call `shape`.
void add_tube(Surface& out, const TubeGrid& grid, bool with_normals, const TubeShape& shape);

/// Returns normals of unit length, 3 for each triangle. The normal of a corner is the mean of those
/// of all triangles that meet at its exact position, weighted by area.
std::vector<vec3> smooth_normals(const Corners& corners);

} // namespace ovc
