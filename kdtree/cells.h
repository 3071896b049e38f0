// SPDX-License-Identifier: Apache-2.0
// Cells: the spaces that a KD-tree's leaves stand for, and which of them a triangle touches.
#pragma once

#include "core/build_progress.h"
#include "core/system/parallel.h"
#include "kdtree/clip.h"
#include "kdtree/tree.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A leaf node of the tree, its closed cell, and the cell with its padding.
struct Cell {
    uint32_t node;
    Box box;
    Box padded;
};

/// Returns the cells of the tree (at least a root) over `bounds`, in the order of their nodes.
std::vector<Cell> cells_of(std::span<const KdNode> nodes, const Box& bounds, double padding);

/// Finds the cells that triangles touch. Keeps references to the nodes and the cells.
class CellFinder {
public:
    CellFinder(std::span<const KdNode> nodes, std::span<const Cell> cells, double padding)
        : nodes_(nodes), cells_(cells), padding_(padding), cell_of_node_(nodes.size()) {
        assert(cells.size() <= nodes.size());
        for (uint32_t i = 0; i < cells.size(); ++i)
            cell_of_node_[cells[i].node] = i;
    }

    /// Calls visit(c) for each cell whose padded box the triangle touches, in the order of cells.
    template <class Visit>
    void find(const Triangle& triangle, Visit&& visit) const {
        if (!nodes_.empty())
            descend(triangle, bounds_of(triangle), 0, visit);
    }

    size_t cells() const { return cells_.size(); }

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
        assert(cells_[c].node == node);
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

/// Triangles are dealt in this many blocks, each with lists of its own, so that the order in which
/// cells get them never depends on threads.
inline constexpr size_t kDealtBlocks = 64;

/// Calls put(block, c, id) for each cell c that a triangle touches, or once with c = finder.cells()
/// where the triangle touches far_cells of them or more. Blocks run in parallel; within one,
/// triangles come in order. A triangle is a unit of progress.
template <class Put>
void deal(const Soup& soup, const CellFinder& finder, std::span<const TriangleId> triangles,
          uint32_t far_cells, BuildProgress* progress, Put&& put) {
    assert(far_cells > 0);
    const size_t size = triangles.size() / kDealtBlocks + 1;
    parallel_for(kDealtBlocks, 1, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        std::vector<uint32_t> touched;
        for (size_t block = first; block < last; ++block) {
            const size_t end = std::min(triangles.size(), (block + 1) * size);
            for (size_t i = block * size; i < end; ++i, loop.step()) {
                touched.clear();
                finder.find(soup.triangle(triangles[i]), [&](uint32_t c) { touched.push_back(c); });
                if (touched.size() >= far_cells)
                    touched = {uint32_t(finder.cells())};
                for (const uint32_t c : touched)
                    put(block, c, triangles[i]);
            }
        }
        loop.finish();
    });
}

} // namespace ovc
