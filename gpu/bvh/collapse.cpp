// SPDX-License-Identifier: Apache-2.0
// Computes costs from the leaves up, and makes choices from the root down.
#include "gpu/bvh/collapse.h"

#include <algorithm>
#include <cassert>

namespace ovc {

static constexpr uint32_t kParallelWeigh = 16384; // nodes

Collapse::Collapse(const std::vector<BvhNode>& nodes, BuildProgress* progress)
    : nodes_(nodes), costs_(nodes.size()), progress_(progress) {
    assert(!nodes.empty());
    in_forks([&](const Fork& fork) { weigh(root(), fork); });
}

/// Returns the cheapest way to put the boxes of an inner node under at most `max_children` nodes, 2
/// to 4, other than itself.
Collapse::Shares Collapse::shares(uint32_t node, int max_children) const {
    assert(max_children >= 2 && max_children <= 4 && !nodes_[node].is_leaf());
    const Costs& left = costs_[node + 1];
    const Costs& right = costs_[nodes_[node].right];
    Shares best{1, max_children - 1, left[0] + right[size_t(max_children - 2)]};
    for (int i = 2; i < max_children; ++i) {
        const float cost = left[size_t(i - 1)] + right[size_t(max_children - i - 1)];
        if (cost < best.cost)
            best = {i, max_children - i, cost};
    }
    return best;
}

void Collapse::weigh(Subtree of, const Fork& fork) {
    const BvhNode& node = nodes_[of.node];
    if (node.is_leaf()) {
        costs_[of.node] = {0, 0, 0}; // every leaf remains
        return;
    }
    if (of.end - of.node > kParallelWeigh) {
        fork([&] { weigh(left(of), fork); }, [&] { weigh(right(of), fork); });
        add(progress_, 0);
    } else {
        weigh(left(of), fork);
        weigh(right(of), fork);
    }
    Costs& costs = costs_[of.node];
    costs[0] = node.box.half_area() + shares(of.node, 4).cost;
    costs[1] = std::min(costs[0], shares(of.node, 2).cost);
    costs[2] = std::min(costs[1], shares(of.node, 3).cost);
}

void Collapse::collect(Subtree of, int max_children, Children& children) const {
    if (!nodes_[of.node].is_leaf() && max_children > 1) {
        const Shares best = shares(of.node, max_children);
        if (best.cost <= costs_[of.node][0]) {
            collect(left(of), best.left, children);
            collect(right(of), best.right, children);
            return;
        }
    }
    assert(size_t(children.count) < children.subtree.size());
    children.subtree[size_t(children.count++)] = of;
}

Children Collapse::children(Subtree of) const {
    Children children{{}, 0};
    if (nodes_[of.node].is_leaf()) {
        children.subtree[0] = of;
        children.count = 1;
        return children;
    }
    const Shares best = shares(of.node, 4);
    collect(left(of), best.left, children);
    collect(right(of), best.right, children);
    return children;
}

} // namespace ovc
