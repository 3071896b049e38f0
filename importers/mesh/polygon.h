// SPDX-License-Identifier: Apache-2.0
// Polygons cut into triangles.
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
/// One that crosses itself, or has more than kMaxConcaveCorners and is concave, is cut somehow.
void triangulate(std::span<const dvec3> corners, std::vector<std::array<uint32_t, 3>>& triangles);

/// The time a corner takes is bounded: 4096 corners take 1 to 30 ms, whatever they are. One that
/// crosses itself may use up that bound, and is cut somehow from there on.
inline constexpr size_t kMaxConcaveCorners = 4096;

} // namespace ovc
