// SPDX-License-Identifier: Apache-2.0
// Triangles in pairs: two that share an edge share two corners, so a pair fits where a triangle
// does.
#pragma once

#include "core/box.h"
#include "core/build_progress.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A leaf's triangle in the leaf's frame, as the kernel sees it.
using LocalTriangle = std::array<vec3, 3>;

/// Triangles `a` = (corners 0, 1, 2) and `b` = (corners 0, 3, 2), named by their index; if b is
/// kNone, a is alone and corner 3 repeats corner 1. Corners may be rotated or mirrored against the
/// triangle's own order.
struct TrianglePair {
    std::array<vec3, 4> corners;
    uint32_t a;
    uint32_t b;
    uint32_t order; // of layout.h: which own corners of a, then of b, corners 0 and 2 are
};

/// Returns pairs that hold every triangle exactly once. Two are joined if they share an edge bit
/// for bit and the joint box costs the surface-area heuristic less than two boxes would. A triangle
/// is a unit of progress.
std::vector<TrianglePair> pair_triangles(std::span<const LocalTriangle> triangles,
                                         BuildProgress* progress = nullptr);

} // namespace ovc
