// SPDX-License-Identifier: Apache-2.0
// Exact planes and points: corners are whole numbers of a grid, so that every plane has whole
// coefficients, every point where three planes meet whole homogeneous ones, and every question
// about them an answer without rounding.
//
// Bits, with coordinates below 2^39: a normal 2^82, an offset 2^123; a point's x 2^290, its w
// 2^248; a plane's value at a point 2^374.
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

/// Grid coordinates, below kGridEnd in size.
using GridPoint = std::array<int64_t, 3>;
inline constexpr int kGridBits = 39;
/// Points are rounded to this many bits behind the grid's point: 52 bits in all, exact in a double.
inline constexpr int kFractionBits = 13;

/// n . p + d; positive above.
struct Plane {
    Int128 n[3];
    Int128 d;
    double near[4]; // n and d, rounded

    Plane(Int128 x, Int128 y, Int128 z, Int128 offset)
        : n{x, y, z}, d(offset), near{double(x), double(y), double(z), double(offset)} {}
};

struct Point {
    Wide x, y, z, w;                  // w > 0
    std::array<int64_t, 3> rounded{}; // in 2^-kFractionBits of the grid; the same for equal points
    dvec3 near{0};                    // rounded, in units of the grid
};

/// Through three corners, counterclockwise seen from above.
Plane plane_through(const GridPoint& a, const GridPoint& b, const GridPoint& c);
/// Along `axis`, through a and b; its normal is across the axis and (b - a).
Plane plane_along(int axis, const GridPoint& a, const GridPoint& b);
inline bool is_null(const Plane& p) {
    return p.n[0] == 0 && p.n[1] == 0 && p.n[2] == 0;
}
/// The axis that the normal is longest along.
int major_axis_of(const Plane& plane);

Point point_of(const GridPoint& p);
/// As a point's `rounded` is.
std::array<int64_t, 3> rounded(const GridPoint& p);
/// Where three planes meet; they must do so in one point.
Point meet(const Plane& a, const Plane& b, const Plane& c);

/// -1 below, 0 on, 1 above.
int side(const Plane& plane, const GridPoint& p);
int side(const Plane& plane, const Point& p);

} // namespace ovc::csg
