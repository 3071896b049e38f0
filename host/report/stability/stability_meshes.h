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

/// The corners of icosphere, lat_long and knot are multiples of this, so that the difference of two
/// is a float.
inline constexpr double kStabilityGrid = 0x1p-12;

/// Closed: neighbours share corners bit for bit. About 1 in size.
Corners icosphere();      // 5,120 triangles
Corners lat_long();       // 16 x 16, each radius drawn from [0.5, 1.5]
Corners small_knot();     // a tube of 4,096 triangles, not star-shaped
Corners box_of_squares(); // the unit cube, its faces cut at multiples of 1/8

struct NamedMesh {
    const char* name;
    Corners (*make)();
};
/// The first three.
std::span<const NamedMesh> closed_meshes();

/// Where and how large a mesh is put.
struct NamedPlace {
    const char* name;
    dvec3 place;
    double scale;
};
/// Far from the origin, small and large.
std::span<const NamedPlace> unpleasant_places();

/// The scan's file in the folder `data`. Error: there is none.
Result<std::string> dragon_file(const std::string& data);

/// The scan in the folder `data`, meshes/stanford-dragon/dragon_vrip.ply or the same packed. It is
/// not closed: it has holes where no scanner looked. Error: there is none, or it cannot be read.
Result<std::shared_ptr<const Scene>> load_dragon(const std::string& data);

/// n x n squares of [-1, 1]^2 at height z.
Corners sheet(int n, double z);
/// The same sheet turned out of all planes.
Corners tilted_sheet(int n);
/// [0, 1] x [0, 256 / aspect] cut into 256 rows of two triangles, 1 long and 1 / aspect high.
Corners sliver_strip(double aspect);
/// Strewn over the unit cube, 1 long and 1 / aspect wide before rounding to float.
Corners strewn_slivers(double aspect);
/// Triangles of 1e-45 to 1e-38 round the origin.
Corners denormal_triangles();
/// 200 triangles of about a kilometre round the origin.
Corners kilometre_triangles();
/// 300 copies of one triangle, each three quarters of the one before.
Corners geometric_series();
/// 400 overlapping rectangles in one plane, in front of a closed wall.
Corners overlapping_walls();
Corners coincident(int count);
/// A cone of `count` triangles round the apex (0, 0, 0).
Corners fan(int count);
/// Points, and corners on one line: nothing of it can be hit.
Corners zero_area();
/// NaN, infinity and minus infinity in each of the nine numbers of copies of the icosphere's
/// triangles.
Corners not_finite();

/// The corners times `scale`, rounded to float, at `place`.
Chunk placed(const Corners& corners, dvec3 place = dvec3(0), double scale = 1);

} // namespace ovc
