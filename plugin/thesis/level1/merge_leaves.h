// SPDX-License-Identifier: Apache-2.0
// Level 1 from the bottom up: merges the leaves of a complete KD-tree until they are as large as
// leaves may be. Based on: thesis, section 3.3.
#pragma once

#include "kdtree/tree.h"

#include <cstdint>
#include <vector>

namespace ovc::thesis {

/// Returns the nodes of `full`, each subtree of at most `max_triangles` (> 0) different triangles
/// merged into one leaf node. Leaf nodes name nothing: fill_cells() of kdtree/partition.h does that
/// anew.
std::vector<KdNode> merge_leaves(const KdTree& full, uint32_t max_triangles);

} // namespace ovc::thesis
