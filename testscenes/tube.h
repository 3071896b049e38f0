// SPDX-License-Identifier: Apache-2.0
// Tubes: closed surfaces of rings between two poles, with as many triangles as asked for.
#pragma once

#include "testscenes/corners.h"

#include <cstdint>
#include <functional>

namespace ovc {

/// Triangles in the making. normals: 3 per triangle where they are wanted, else empty.
struct Surface {
    Corners corners;
    std::vector<vec3> normals;
};

/// How a tube is cut: `along` rings of `around` points. The first `crossed` of the quads between
/// rings are four triangles round their middle, all others two.
struct TubeGrid {
    uint32_t around = 3, along = 2;
    uint64_t crossed = 0;

    uint64_t triangles() const { return 2 * (uint64_t(around) * along + crossed); }
};

/// The fewest triangles that tube_grid() takes.
inline constexpr uint64_t kMinTubeTriangles = 12;

/// A grid of exactly `triangles`, even and not less than kMinTubeTriangles, with about
/// `rings_per_point` rings for each point of a ring.
TubeGrid tube_grid(uint64_t triangles, double rings_per_point);

/// Where a tube's points lie. Ring 0 and ring `along` + 1 are the poles. Turns go from 0 to 1
/// round a ring, seen from the end of the tube against the clock.
using TubeShape = std::function<dvec3(uint32_t ring, double turns)>;

/// Appends the tube; shape is called from several threads.
void add_tube(Surface& out, const TubeGrid& grid, bool with_normals, const TubeShape& shape);

/// Normals for corners that share their positions bit for bit: of all triangles that meet there,
/// the larger the more. 3 per triangle, unit length.
std::vector<vec3> smooth_normals(const Corners& corners);

} // namespace ovc
