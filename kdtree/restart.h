// SPDX-License-Identifier: Apache-2.0
// Level-1 traversal that can stop at a leaf and go on later: each ray keeps only the t that it has
// reached. Based on: Foley and Sugerman 2005, section 3.1 (kd-restart); thesis, section 3.4
// (algorithm 4).
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/partition.h"

namespace ovc {

/// A leaf on a ray's way, and the part of the ray inside its box, which is a little more than
/// inside its cell.
struct Visit {
    uint32_t leaf = kNone;
    Interval inside{1, 0};
};

/// Where a ray stands on level 1: all cells up to t are done, except leaves [next, end) of the last
/// of them. A walk starts with t = t_min of the ray.
struct RayPosition {
    double t = 0;
    uint32_t next = 0;
    uint32_t end = 0;
};

/// Returns whether double precision and the padding of leaves suffice to walk level 1 plane by
/// plane along this ray. They do not where the origin is so far away, or the direction so uneven,
/// that the ray's place in a leaf is lost to rounding. Such a ray must go to the exact fallback
/// (plugin/fallback/exact_fallback.h).
bool can_walk(const Level1& level1, const PreparedRay& p);

/// Returns the next leaf along the ray, and moves `position` past it; leaf == kNone when there is
/// none. Leaves come in order of entry, each once. Needs can_walk().
Visit next_leaf(const Level1& level1, const PreparedRay& p, RayPosition& position);

/// Does the same, but returns no leaf beyond the cell of the last one. A ray that was hit there
/// goes on with this, because a hit in a cell is nearer than anything in later cells.
Visit next_leaf_in_cell(const Level1& level1, const PreparedRay& p, RayPosition& position);

} // namespace ovc
