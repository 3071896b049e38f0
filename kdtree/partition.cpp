// SPDX-License-Identifier: Apache-2.0
// Level 1: the KD-tree stopped by count, then every cell padded and its triangles gathered again.
#include "kdtree/partition.h"

#include "core/parallel.h"
#include "kdtree/build.h"
#include "kdtree/clip.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <span>

namespace ovc {
namespace {

/// Of the leaf's largest extent. The kernel sees a ray within the leaf's box and cannot prove a hit
/// that lies within a rounding of either end. This keeps what is hit in the cell clear of the ends,
/// even on triangles hundreds of times the size of the leaf, whose roundings are as much larger
/// (docs/numerics.md).
constexpr double kMargin = 0x1p-10;

/// A leaf node of the tree, the closed cell it stands for, and the cell with its padding.
struct Cell {
    uint32_t node;
    Box box;
    Box padded;
};

/// A few roundings of the coordinates, and enough for rays from a thousand scene sizes away to be
/// walked in double (can_walk).
double padding_of(const Box& scene) {
    const double farthest = max_component(glm::max(glm::abs(scene.lo), glm::abs(scene.hi)));
    return std::max(0x1p-48 * farthest, 0x1p-36 * max_component(scene.extent()));
}

void collect_cells(const std::vector<KdNode>& nodes, uint32_t node, const Box& box,
                   std::vector<Cell>& cells) {
    if (nodes[node].is_leaf()) {
        cells.push_back({node, box, {}});
        return;
    }
    Box below = box;
    Box above = box;
    below.hi[nodes[node].axis()] = above.lo[nodes[node].axis()] = nodes[node].split();
    collect_cells(nodes, node + 1, below, cells);
    collect_cells(nodes, nodes[node].above(), above, cells);
}

/// Hands each triangle to every cell whose padded box it touches.
class Gatherer {
public:
    Gatherer(const Soup& soup, const std::vector<KdNode>& nodes, const Box& bounds,
             const std::vector<Cell>& cells, double padding)
        : soup_(soup),
          nodes_(nodes),
          bounds_(bounds),
          cells_(cells),
          padding_(padding),
          cell_of_node_(nodes.size()) {
        for (uint32_t i = 0; i < cells.size(); ++i)
            cell_of_node_[cells[i].node] = i;
    }

    /// members[c]: the triangles of cell c, in the order of `triangles`.
    std::vector<std::vector<TriangleId>> gather(std::span<const TriangleId> triangles) const {
        constexpr size_t kBlocks =
            64; // each with lists of its own, so that the order never depends on threads
        const size_t block = triangles.size() / kBlocks + 1;
        std::vector<std::vector<std::vector<TriangleId>>> parts(kBlocks);
        parallel_for(kBlocks, 1, [&](size_t first, size_t last) {
            for (size_t b = first; b < last; ++b) {
                parts[b].resize(cells_.size());
                const size_t end = std::min(triangles.size(), (b + 1) * block);
                for (size_t i = b * block; i < end; ++i)
                    hand_out(triangles[i], parts[b]);
            }
        });
        std::vector<std::vector<TriangleId>> members(cells_.size());
        parallel_for(cells_.size(), 1, [&](size_t first, size_t last) {
            for (size_t c = first; c < last; ++c)
                for (auto& part : parts) {
                    members[c].insert(members[c].end(), part[c].begin(), part[c].end());
                    part[c] = {};
                }
        });
        return members;
    }

private:
    void hand_out(TriangleId id, std::vector<std::vector<TriangleId>>& lists) const {
        const Triangle triangle = soup_.triangle(id);
        hand_down(id, triangle, bounds_of(triangle), 0, bounds_, lists);
    }

    void hand_down(TriangleId id, const Triangle& triangle, const Box& box, uint32_t node,
                   const Box& cell, std::vector<std::vector<TriangleId>>& lists) const {
        const KdNode& n = nodes_[node];
        if (n.is_leaf()) {
            const uint32_t c = cell_of_node_[node];
            const Box& padded = cells_[c].padded;
            const bool inside = padded.contains(box.lo) && padded.contains(box.hi);
            if (inside || (padded.touches(box) && !clipped_bounds(triangle, padded).empty()))
                lists[c].push_back(id);
            return;
        }
        const int axis = n.axis();
        if (box.lo[axis] <= n.split() + padding_) {
            Box below = cell;
            below.hi[axis] = n.split();
            hand_down(id, triangle, box, node + 1, below, lists);
        }
        if (box.hi[axis] >= n.split() - padding_) {
            Box above = cell;
            above.lo[axis] = n.split();
            hand_down(id, triangle, box, n.above(), above, lists);
        }
    }

    const Soup& soup_;
    const std::vector<KdNode>& nodes_;
    const Box& bounds_;
    const std::vector<Cell>& cells_;
    const double padding_;
    std::vector<uint32_t> cell_of_node_;
};

Frame frame_of(const Box& box, double reach) {
    // A triangle may reach far out of its leaf; 2^40 leaf sizes still leave the kernel's cubes of
    // coordinates finite.
    const double size = std::max(max_component(box.extent()) * 0.5, reach * 0x1p-40);
    int exponent = 0;
    std::frexp(size, &exponent);
    return {box.center(), size > 0 ? std::ldexp(1.0, -exponent) : 1.0};
}

/// padding: what double rounding may move a ray by; the box must not be missed for it, however
/// small the leaf is.
Leaf make_leaf(const Soup& soup, const Box& cell, double padding,
               std::span<const TriangleId> triangles) {
    Leaf leaf;
    Box all;
    for (const TriangleId id : triangles)
        all.add(bounds_of(soup.triangle(id)));
    leaf.cell = cell;
    const Box reached = all.intersection(cell);
    leaf.box = reached.padded(std::max(kMargin * max_component(reached.extent()), padding));
    leaf.frame = frame_of(leaf.box, max_component(all.extent()));
    leaf.triangles.assign(triangles.begin(), triangles.end());
    return leaf;
}

} // namespace

uint64_t Level1::reference_count() const {
    uint64_t count = 0;
    for (const Leaf& leaf : leaves)
        count += leaf.triangles.size();
    return count;
}

Leaf whole_leaf(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds) {
    const double padding = padding_of(bounds);
    return make_leaf(soup, bounds.padded(padding), padding, triangles);
}

Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles) {
    assert(max_leaf_triangles > 0);
    KdBuildOptions options;
    options.max_leaf_triangles = max_leaf_triangles;
    KdTree tree = build_kd_tree(soup, triangles, bounds, options);

    Level1 level1;
    level1.bounds = bounds;
    if (tree.nodes.empty())
        return level1;
    std::vector<Cell> cells;
    collect_cells(tree.nodes, 0, bounds, cells);
    level1.padding = padding_of(bounds);
    for (Cell& cell : cells)
        cell.padded = cell.box.padded(level1.padding);
    tree.references = {};
    const std::vector<std::vector<TriangleId>> members =
        Gatherer(soup, tree.nodes, bounds, cells, level1.padding).gather(triangles);

    for (size_t i = 0; i < cells.size(); ++i) {
        const uint32_t first = uint32_t(level1.leaves.size());
        const std::span<const TriangleId> inside = members[i];
        for (size_t at = 0; at < inside.size(); at += max_leaf_triangles)
            level1.leaves.push_back(make_leaf(
                soup, cells[i].padded, level1.padding,
                inside.subspan(at, std::min<size_t>(max_leaf_triangles, inside.size() - at))));
        tree.nodes[cells[i].node] = KdNode::leaf(first, uint32_t(level1.leaves.size()) - first);
    }
    level1.nodes = std::move(tree.nodes);
    return level1;
}

} // namespace ovc
