// SPDX-License-Identifier: Apache-2.0
// Reinsertion: subtrees of a BVH move to where they cost less. A builder decides at the top first,
// where it knows least: a floor's two triangles end up deep among the pipes that stand on it.
// Based on: Bittner, Hapala and Havran 2013, "Fast Insertion-Based Optimization of Bounding Volume
// Hierarchies"; Meister and Bittner 2018, "Parallel Reinsertion for Bounding Volume Hierarchy
// Optimization".
#pragma once

#include "core/build_progress.h"
#include "gpu/bvh/bvh.h"

#include <vector>

namespace ovc {

/// The same leaves in a tree that costs less, or as much, and is no higher: the half areas of its
/// inner nodes, added up. It goes on while that gains much, so a good tree costs little time. The
/// same on any number of threads. nodes: at most kMaxBvhDepth high; of the result none is unused.
/// Asks `progress` whether to go on.
void reinsert(std::vector<BvhNode>& nodes, BuildProgress* progress = nullptr);

} // namespace ovc
