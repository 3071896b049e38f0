// SPDX-License-Identifier: Apache-2.0
// Cells: the spaces that a KD-tree's leaves stand for, and which of them a triangle touches.
#pragma once

#include "kdtree/clip.h"
#include "kdtree/tree.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A leaf node of the tree, the closed cell it stands for, and the cell with its padding.
struct Cell {
    uint32_t node;
    Box box;
    Box padded;
};

/// The cells of the tree over `bounds`, in the order of their nodes.
std::vector<Cell> cells_of(std::span<const KdNode> nodes, const Box& bounds, double padding);

/// Finds the cells that triangles touch. Keeps references to the nodes and the cells.
class CellFinder {
public:
    CellFinder(std::span<const KdNode> nodes, std::span<const Cell> cells, double padding)
        : nodes_(nodes), cells_(cells), padding_(padding), cell_of_node_(nodes.size()) {
        for (uint32_t i = 0; i < cells.size(); ++i)
            cell_of_node_[cells[i].node] = i;
    }

    /// visit(c) for each cell whose padded box the triangle touches, in the order of cells.
    template <class Visit>
    void find(const Triangle& triangle, Visit&& visit) const {
        if (!nodes_.empty())
            descend(triangle, bounds_of(triangle), 0, visit);
    }

private:
    template <class Visit>
    void descend(const Triangle& triangle, const Box& box, uint32_t node, Visit&& visit) const {
        while (!nodes_[node].is_leaf()) {
            const KdNode& n = nodes_[node];
            const int axis = n.axis();
            const bool below = box.lo[axis] <= n.split() + padding_;
            const bool above = box.hi[axis] >= n.split() - padding_;
            if (below && above)
                descend(triangle, box, node + 1, visit);
            node = above ? n.above() : node + 1;
        }
        const uint32_t c = cell_of_node_[node];
        const Box& padded = cells_[c].padded;
        const bool inside = padded.contains(box.lo) && padded.contains(box.hi);
        if (inside || (padded.touches(box) && !clipped_bounds(triangle, padded).empty()))
            visit(c);
    }

    std::span<const KdNode> nodes_;
    std::span<const Cell> cells_;
    const double padding_;
    std::vector<uint32_t> cell_of_node_;
};

} // namespace ovc
