// SPDX-License-Identifier: Apache-2.0
// triangulate() cuts polygons into triangles.
#pragma once

#include "core/vec.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Appends the triangles of the polygon as indices into `corners`: size - 2 of them, wound as the
/// polygon is; none for fewer than three corners. A convex polygon becomes the fan of corner 0. A
/// concave one, holes cut in by a bridge included, is cut without overlap as seen along its normal.
/// The cut of a polygon that crosses itself or has a NaN, or of a concave one of more than
/// kMaxConcaveCorners, is not specified.
void triangulate(std::span<const dvec3> corners, std::vector<std::array<uint32_t, 3>>& triangles);

/// Bounds the time: 4096 corners take 1 to 30 ms, whatever they are. A polygon that crosses itself
/// may use up that bound; the rest of its cut is then arbitrary.
inline constexpr size_t kMaxConcaveCorners = 4096;

} // namespace ovc
