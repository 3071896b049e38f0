// SPDX-License-Identifier: Apache-2.0
// Collapse: decides which nodes of a binary BVH remain when a node has up to four children. Based
// on: Ylitie, Karras and Laine 2017, "Efficient Incoherent Ray Traversal on GPUs Through Compressed
// Wide BVHs", section 4.1.
#pragma once

#include "core/build_progress.h"
#include "core/system/parallel.h"
#include "gpu/bvh/bvh.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc {

/// A subtree of a BVH, which lies in the nodes [node, end).
struct Subtree {
    uint32_t node;
    uint32_t end;
};

/// Up to four subtrees that together hold the boxes of one.
struct Children {
    std::array<Subtree, 4> subtree;
    int count;
};

/// The cheapest choice by the surface-area heuristic: it minimises the sum of the areas of all
/// nodes that remain. It is the same on any number of threads.
class Collapse {
public:
    /// Keeps a reference to `nodes`, which are not empty. Throws Cancelled if `progress` is told to
    /// stop.
    Collapse(const std::vector<BvhNode>& nodes, BuildProgress* progress);

    Subtree root() const { return {0, uint32_t(nodes_.size())}; }

    /// Returns the children of a node that remains; for a leaf, the leaf itself.
    Children children(Subtree of) const;

private:
    /// The costs of a subtree whose boxes may lie under up to 1, 2, 3 nodes.
    using Costs = std::array<float, 3>;

    /// The max number of nodes on either side, and the cost of that choice.
    struct Shares {
        int left;
        int right;
        float cost;
    };

    Subtree left(Subtree of) const { return {of.node + 1, nodes_[of.node].right}; }
    Subtree right(Subtree of) const { return {nodes_[of.node].right, of.end}; }
    Shares shares(uint32_t node, int max_children) const;
    void weigh(Subtree of, const Fork& fork);
    void collect(Subtree of, int max_children, Children& children) const;

    const std::vector<BvhNode>& nodes_;
    std::vector<Costs> costs_;
    BuildProgress* const progress_;
};

} // namespace ovc
