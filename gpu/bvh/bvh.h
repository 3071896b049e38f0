// SPDX-License-Identifier: Apache-2.0
// Builds a binary bounding volume hierarchy over boxes, one box a leaf. The packer collapses it to
// four children a node (page.h). Based on: Wald 2007, "On fast Construction of SAH-based Bounding
// Volume Hierarchies" (binning); Stich, Friedrich and Dietrich 2009 (spatial splits).
#pragma once

#include "core/box.h"
#include "core/build_progress.h"
#include "gpu/bvh/pairs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A subtree over n boxes takes 2 n - 1 nodes in a row: its root, then the subtree of `left`, then
/// that of `right`. If boxes may be cut (build_split_bvh), it takes the nodes for the max number of
/// boxes, and some are not used.
struct BvhNode {
    Boxf box;
    uint32_t right = 0; // inner: index of the right child; the left one is the next node
    uint32_t item = 0;  // leaf: index of the box
    bool is_leaf() const { return right == 0; }
};

/// Returns the hierarchy over `boxes` (none of them empty), root first; empty for no boxes. The
/// result is deterministic and at most kMaxBvhDepth deep. A box is a unit of progress.
std::vector<BvhNode> build_bvh(std::span<const Boxf> boxes, BuildProgress* progress = nullptr);

/// Returns the same over the boxes of `pairs`. Planes cut up to `max_added` of them in two if the
/// heuristic gains by it; each part is a leaf of its own. Every point of a pair that is in its box
/// is in one of the parts' boxes (cut_pair.h).
std::vector<BvhNode> build_split_bvh(std::span<const Boxf> boxes,
                                     std::span<const TrianglePair> pairs, size_t max_added,
                                     BuildProgress* progress = nullptr);

/// The max number of inner levels of any tree of build_bvh. Where the heuristic would go deeper,
/// the builder halves by count instead.
inline constexpr int kMaxBvhDepth = 48;

} // namespace ovc
