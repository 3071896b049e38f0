// SPDX-License-Identifier: Apache-2.0
// Exact planes and points. Corners have integer coordinates on a grid. So planes have integer
// coefficients, points where three planes meet have integer homogeneous coordinates, and the side
// of a plane that a point is on is found without rounding.
//
// With coordinates below 2^39, a normal is below 2^82, an offset below 2^123, a point's x below
// 2^290, its w below 2^248, and a plane's value at a point below 2^374.
// Source: Bernstein and Fussell 2009, "Fast, Exact, Linear Booleans", section 3.
#pragma once

#include "core/vec.h"

#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cstdint>

namespace ovc::csg {

__extension__ using Int128 = __int128;
using Wide = boost::multiprecision::number<boost::multiprecision::cpp_int_backend<
    384, 384, boost::multiprecision::signed_magnitude, boost::multiprecision::unchecked, void>>;

/// Coordinates on the grid, below 2^kGridBits in size.
using GridPoint = std::array<int64_t, 3>;
inline constexpr int kGridBits = 39;
/// Points are rounded to this many fractional bits. They then have 52 bits in all, which a double
/// holds.
inline constexpr int kFractionBits = 13;
/// The corners of results are multiples of 2^kSnapBits steps of the grid.
inline constexpr int kSnapBits = 3;

/// The points p with n . p + d = 0. The sum is positive above the plane.
struct Plane {
    Int128 n[3];
    Int128 d;
    double near[4]; // n and d rounded to double

    Plane(Int128 x, Int128 y, Int128 z, Int128 offset)
        : n{x, y, z}, d(offset), near{double(x), double(y), double(z), double(offset)} {}
};

struct Point {
    Wide x, y, z, w;                  // w > 0
    std::array<int64_t, 3> rounded{}; // in 2^-kFractionBits of the grid, the same for equal points
    dvec3 near{0};                    // `rounded` in units of the grid
};

/// Returns the plane through three corners, which run counterclockwise seen from above.
Plane plane_through(const GridPoint& a, const GridPoint& b, const GridPoint& c);
/// Returns the plane through a and b that is parallel to `axis`.
Plane plane_along(int axis, const GridPoint& a, const GridPoint& b);
inline bool is_null(const Plane& p) {
    return p.n[0] == 0 && p.n[1] == 0 && p.n[2] == 0;
}
/// Returns the axis along which the normal is longest.
int major_axis_of(const Plane& plane);

Point point_of(const GridPoint& p);
/// Returns the point in the units of Point::rounded.
std::array<int64_t, 3> rounded(const GridPoint& p);
/// Returns the point where three planes meet. They must meet in one point.
Point meet(const Plane& a, const Plane& b, const Plane& c);

/// Returns -1 for a point below the plane, 0 for one on it, 1 for one above it.
int side(const Plane& plane, const GridPoint& p);
int side(const Plane& plane, const Point& p);

} // namespace ovc::csg
