// SPDX-License-Identifier: Apache-2.0
// Reinsertion: moves subtrees of a BVH to places where they cost less. A builder decides at the top
// first, where it knows least: a floor's two triangles end up deep among the pipes that stand on
// it. Based on: Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding
// Volume Hierarchies"; Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume
// Hierarchy Optimization".
#pragma once

#include "core/build_progress.h"
#include "gpu/bvh/bvh.h"

#include <vector>

namespace ovc {

/// How much of the time goes into reinsertion. A round tries the most promising of the subtrees: a
/// twentieth of them, but at least `min_tried`. The last round is the one that gains at most the
/// share `worthwhile` of the cost.
struct ReinsertEffort {
    size_t min_tried = 1;
    double worthwhile = 0.01;
};

/// For a small tree that many rays go through: its rounds try every subtree.
inline constexpr ReinsertEffort kThorough{4096, 0.0001};

/// Changes the tree over the same leaves to one that costs no more, by the sum of half areas over
/// its inner nodes, and is no higher. The result is the same on any number of threads and has no
/// unused nodes. nodes: at most kMaxBvhDepth high. Throws Cancelled if `progress` is told to stop.
void reinsert(std::vector<BvhNode>& nodes, BuildProgress* progress = nullptr,
              const ReinsertEffort& effort = {});

} // namespace ovc
