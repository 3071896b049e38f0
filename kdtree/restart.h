// SPDX-License-Identifier: Apache-2.0
// Level-1 traversal that can stop at a leaf and go on later: each ray keeps only the t it has come
// to. Based on: Foley and Sugerman 2005, section 3.1 (kd-restart); thesis, section 3.4 (algorithm
// 4).
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/partition.h"

namespace ovc {

/// A leaf on a ray's way, and the part of the ray inside its box (a little more than inside its
/// cell).
struct Visit {
    uint32_t leaf = kNone;
    Interval inside{1, 0};
};

/// Where a ray stands on level 1: cells up to t are done, but for leaves [next, end) of the last of
/// them. Start with t = t_min of the ray.
struct RayPosition {
    double t = 0;
    uint32_t next = 0;
    uint32_t end = 0;
};

/// True when double precision and the padding of leaves suffice to walk level 1 plane by plane
/// along this ray. A ray for which they do not (its origin so far away, or its direction so uneven,
/// that its place in a leaf is lost to rounding) must be answered by the thick-planed walk of
/// kdtree/walk.h.
bool can_walk(const Level1& level1, const PreparedRay& p);

/// The next leaf along the ray, and `position` moved past it; leaf == kNone when there is none.
/// Leaves come in order of entry, each once. Needs can_walk().
Visit next_leaf(const Level1& level1, const PreparedRay& p, RayPosition& position);

/// The same, but no leaf beyond the cell of the last one: where a ray goes on that was hit there,
/// since what is hit in a cell is nearer than anything in later cells.
Visit next_leaf_in_cell(const Level1& level1, const PreparedRay& p, RayPosition& position);

} // namespace ovc
