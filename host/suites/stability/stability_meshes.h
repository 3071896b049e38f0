// SPDX-License-Identifier: Apache-2.0
// The triangles of the stability suite: closed meshes, and triangles that are hard on arithmetic.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "testscenes/corners.h"

#include <memory>
#include <span>
#include <string>

namespace ovc {

/// The corners of icosphere, lat_long and small_knot are multiples of this, so that the difference
/// of two is a float.
inline constexpr double kStabilityGrid = 0x1p-12;

/// These are closed, because neighbours share corners bit for bit, and about 1 in size.
Corners icosphere();      // 5,120 triangles
Corners lat_long();       // 16 x 16, each radius drawn from [0.5, 1.5]
Corners small_knot();     // a tube of 4,096 triangles, not star-shaped
Corners box_of_squares(); // the unit cube, its faces cut at multiples of 1/8

struct NamedMesh {
    const char* name;
    Corners (*make)();
};
/// Returns icosphere, lat_long and small_knot.
std::span<const NamedMesh> closed_meshes();

/// A place and a scale for a mesh.
struct NamedPlace {
    const char* name;
    dvec3 place;
    double scale;
};
/// Returns places far from the origin, and small and large scales.
std::span<const NamedPlace> unpleasant_places();

/// Returns the path of the scan's file in the folder `data`. Error: there is none.
Result<std::string> dragon_file(const std::string& data);

/// Returns the scan in the folder `data`, meshes/stanford-dragon/dragon_vrip.ply or the same
/// packed. It is not closed: it has holes where no scanner looked. Error: there is none, or it
/// cannot be read.
Result<std::unique_ptr<const Scene>> load_dragon(const std::string& data);

/// Returns n x n squares of [-1, 1]^2 at height z.
Corners sheet(int n, double z);
/// Returns such a sheet through the origin, tilted against all axes.
Corners tilted_sheet(int n);
/// Returns [0, 1] x [0, 256 / aspect] cut into 256 rows of two triangles, 1 long and 1 / aspect
/// high.
Corners sliver_strip(double aspect);
/// Returns 1000 triangles strewn over the unit cube, 1 long and 1 / aspect wide before rounding to
/// float.
Corners strewn_slivers(double aspect);
/// Returns 500 triangles of sizes from 1e-44 to 1e-37 round the origin.
Corners denormal_triangles();
/// Returns 200 triangles of about a kilometre round the origin.
Corners kilometre_triangles();
/// Returns 300 copies of one triangle, each three quarters of the one before.
Corners geometric_series();
/// Returns 400 overlapping rectangles in one plane, in front of a closed wall.
Corners overlapping_walls();
Corners coincident(int count);
/// Returns a cone of `count` triangles round the apex (0, 0, 0).
Corners fan(int count);
/// Returns triangles with two equal corners or all corners on one line, which no ray can hit.
Corners zero_area();
/// Returns copies of the icosphere's triangles, each with NaN, infinity or minus infinity in one of
/// its nine numbers.
Corners not_finite();

/// Returns the corners times `scale`, rounded to float, at `place`.
Chunk placed(const Corners& corners, dvec3 place = dvec3(0), double scale = 1);

} // namespace ovc
