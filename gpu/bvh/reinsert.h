// SPDX-License-Identifier: Apache-2.0
// Reinsertion: moves subtrees of a BVH to places where they cost less. A builder decides at the top
// first, where it knows least: a floor's two triangles end up deep among the pipes that stand on
// it. Hierarchies"; Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization".
#pragma once

#include "core/build_progress.h"
#include "gpu/bvh/bvh.h"

#include <vector>

namespace ovc {

/// Changes the tree over the same leaves to one that costs no more, by the sum of half areas over
/// its inner nodes, and is no higher. It goes on while rounds gain much, so a good tree costs
/// little time. The result is the same on any number of threads and has no unused nodes. nodes: at
/// most kMaxBvhDepth high. Throws Cancelled if `progress` is told to stop.
void reinsert(std::vector<BvhNode>& nodes, BuildProgress* progress = nullptr);

} // namespace ovc
