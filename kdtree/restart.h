// SPDX-License-Identifier: Apache-2.0
// Level-1 traversal that can stop at a leaf and go on later: each ray keeps only the t it has come
// to. Based on: Foley and Sugerman 2005, section 3.1 (kd-restart); thesis, section 3.4 (algorithm
// 4).
#pragma once

#include "core/triangle.h"
#include "kdtree/partition.h"

namespace ovc {

/// A leaf on a ray's way, and the part of the ray inside its box.
struct Visit {
    uint32_t leaf = kNone;
    Interval inside{1, 0};
};

/// Where a ray stands on level 1. Start with t = t_min of the ray.
struct RayPosition {
    double t = 0;      // cells before are done
    uint32_t done = 0; // leaves of the cell at t that are done, where a cell has several
};

/// True when double precision and the padding of leaves suffice to walk level 1 plane by plane
/// along this ray. A ray for which they do not (its origin so far away, or its direction so uneven,
/// that its place in a leaf is lost to rounding) must be answered by the thick-planed walk of
/// kdtree/walk.h.
bool can_walk(const Level1& level1, const PreparedRay& p);

/// The next leaf along the ray at or after `position`, which is moved past it; leaf == kNone when
/// there is none. Leaves come in order of entry, each once. Needs can_walk().
Visit next_leaf(const Level1& level1, const PreparedRay& p, RayPosition& position);

} // namespace ovc
