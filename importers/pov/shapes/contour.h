// SPDX-License-Identifier: Apache-2.0
// Contours in a plane: curves of points, and what lies inside an odd number of them.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace ovc::pov {

/// A closed curve; the first point is not repeated.
using Contour = std::vector<dvec2>;

/// Triangles, counterclockwise, over the points of all contours in order; contours may lie in each
/// other but not cross.
std::vector<std::array<uint32_t, 3>> cut_contours(const std::vector<Contour>& contours);

/// By crossings of a line to the right; a point on the contour is on either side.
bool is_inside(const dvec2& p, const Contour& contour);

/// Twice the area, above 0 where the contour runs counterclockwise.
double doubled_area(const Contour& contour);

enum class Curve { Linear, Quadratic, Cubic, Bezier };

/// How many points a curve takes before it can have a piece.
size_t points_of_a_piece(Curve curve);

/// A point of one piece, t in [0, 1], and its direction: of the points from p on.
dvec2 curve_point(Curve curve, const dvec2* p, double t, dvec2* direction);

} // namespace ovc::pov
