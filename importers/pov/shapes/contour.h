// SPDX-License-Identifier: Apache-2.0
// Contours: closed curves in a plane. A point inside an odd number of them is inside the shape.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace ovc::pov {

/// A closed curve; the first point is not repeated.
using Contour = std::vector<dvec2>;

/// Returns counterclockwise triangles, which index the points of all contours in order. Contours
/// may lie in each other and touch at points, but not cross (simple_contours()).
std::vector<std::array<uint32_t, 3>> cut_contours(const std::vector<Contour>& contours);

/// Returns whether the point is inside, by counting the edges to the right of it. A point on the
/// contour may count as inside or outside.
bool is_inside(const dvec2& p, const Contour& contour);

/// Returns how many of the contours lie around this one of them, which they do not cross.
size_t depth_of(const Contour& contour, const std::vector<Contour>& contours);

/// Returns twice the area, which is above 0 where the contour runs counterclockwise.
double doubled_area(const Contour& contour);

enum class Curve { Linear, Quadratic, Cubic, Bezier };

/// Returns how many control points one piece of the curve has.
size_t points_of_a_piece(Curve curve);

/// Returns the point at t in [0, 1] of the piece whose points_of_a_piece() control points start at
/// `p`. Stores the derivative in `direction` unless that is null.
dvec2 curve_point(Curve curve, const dvec2* p, double t, dvec2* direction);

} // namespace ovc::pov
