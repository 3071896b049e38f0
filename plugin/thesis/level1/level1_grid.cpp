// SPDX-License-Identifier: Apache-2.0
// The grid: its fineness, its cells as those of a KD-tree of equal parts, and its walk.
#include "plugin/thesis/level1/level1_grid.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc::thesis {
namespace {

constexpr uint64_t kMaxGridCells = 1 << 24;

using Place = std::array<uint32_t, 3>; // of a cell, along x, y and z

Place place_of(const Grid& grid, uint32_t cell) {
    return {cell % grid.count[0], cell / grid.count[0] % grid.count[1],
            cell / grid.count[0] / grid.count[1]};
}

uint32_t number_of(const Grid& grid, const Place& at) {
    return (at[2] * grid.count[1] + at[1]) * grid.count[0] + at[0];
}

/// Adds cells, one at a time along the axis on which cells are longest, until there are `cells`.
void refine(Grid& grid, uint64_t cells) {
    const dvec3 extent = grid.bounds.extent();
    const auto length = [&](int axis) { return extent[axis] / grid.count[axis]; };
    while (grid.cell_count() < cells) {
        int longest = 0;
        for (int axis = 1; axis < 3; ++axis)
            if (length(axis) > length(longest))
                longest = axis;
        ++grid.count[longest];
    }
}

/// Returns the number of triangles in the fullest cell, by the centres of their boxes.
uint32_t fullest(const Grid& grid, std::span<const dvec3> centers) {
    std::vector<uint32_t> counts(grid.cell_count());
    for (const dvec3& center : centers)
        ++counts[grid.cell_at(center)];
    return *std::max_element(counts.begin(), counts.end());
}

Grid choose_grid(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_triangles) {
    std::vector<dvec3> centers;
    centers.reserve(triangles.size());
    for (const TriangleId id : triangles)
        centers.push_back(bounds_of(soup.triangle(id)).center());
    const uint64_t enough = (triangles.size() + max_triangles - 1) / max_triangles;
    const uint64_t finest = std::min(kMaxCellsPerLeaf * enough, kMaxGridCells);
    Grid grid;
    grid.bounds = bounds;
    refine(grid, std::min(enough, finest));
    while (fullest(grid, centers) > max_triangles && grid.cell_count() < finest) {
        const uint64_t more = uint64_t(grid.cell_count()) * 5 / 4 + 1;
        refine(grid, std::min(more, finest));
    }
    return grid;
}

/// Appends the tree that halves the block of cells [from, to], and its cells in that order.
void halve(const Grid& grid, const Place& from, const Place& to, std::vector<KdNode>& nodes,
           std::vector<uint32_t>& cells) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (to[other] - from[other] > to[axis] - from[axis])
            axis = other;
    if (from[axis] == to[axis]) {
        nodes.push_back(KdNode::leaf(0, 0));
        cells.push_back(number_of(grid, from));
        return;
    }
    const uint32_t middle = (from[axis] + to[axis]) / 2;
    Place below = to, above = from;
    below[axis] = middle;
    above[axis] = middle + 1;
    const size_t at = nodes.size();
    nodes.push_back(KdNode::inner(axis, grid.plane(axis, middle + 1)));
    halve(grid, from, below, nodes, cells);
    nodes[at].set_above(uint32_t(nodes.size()));
    halve(grid, above, to, nodes, cells);
}

} // namespace

double Grid::plane(int axis, uint32_t i) const {
    assert(axis >= 0 && axis < 3 && i <= count[axis]);
    if (i == count[axis])
        return bounds.hi[axis];
    return bounds.lo[axis] + bounds.extent()[axis] * (double(i) / count[axis]);
}

uint32_t Grid::cell_at(const dvec3& point) const {
    Place at{};
    for (int axis = 0; axis < 3; ++axis) {
        if (count[axis] == 1)
            continue; // the box may have no extent along this axis
        const double i = (point[axis] - bounds.lo[axis]) / bounds.extent()[axis] * count[axis];
        at[axis] = uint32_t(std::clamp(std::floor(i), 0.0, double(count[axis] - 1)));
    }
    return number_of(*this, at);
}

Level1 cut_into_grid(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                     uint32_t max_leaf_triangles, Grid& grid) {
    assert(max_leaf_triangles > 0);
    if (triangles.empty())
        return {};
    grid = choose_grid(soup, triangles, bounds, max_leaf_triangles);
    std::vector<KdNode> nodes;
    std::vector<uint32_t> order;
    halve(grid, {0, 0, 0}, {grid.count[0] - 1, grid.count[1] - 1, grid.count[2] - 1}, nodes, order);
    Level1 level1 = fill_cells(soup, triangles, bounds, std::move(nodes), max_leaf_triangles);
    assert(order.size() == grid.cell_count());
    grid.cells.resize(order.size());
    size_t next = 0;
    for (const KdNode& node : level1.nodes)
        if (node.is_leaf())
            grid.cells[order[next++]] = {node.first(), node.first() + node.count()};
    return level1;
}

uint32_t next_cell(const Grid& grid, double padding, const PreparedRay& p, uint32_t cell) {
    if (cell == kBeforeGrid) {
        const Interval inside = clip(p, grid.bounds.padded(padding), p.ray.t_min, p.ray.t_max);
        return inside.empty() ? kBehindGrid : grid.cell_at(p.ray.org + inside.enter * p.ray.dir);
    }
    assert(cell < grid.cell_count());
    Place at = place_of(grid, cell);
    // The t of a plane is always computed in the same way, so the ray passes each plane once, and
    // the padding of cells makes up for the error of t.
    double exit = std::numeric_limits<double>::infinity();
    int through = -1;
    for (int axis = 0; axis < 3; ++axis) {
        if (p.ray.dir[axis] == 0)
            continue;
        const uint32_t ahead = at[axis] + (p.ray.dir[axis] > 0 ? 1 : 0);
        const double t = (grid.plane(axis, ahead) - p.ray.org[axis]) * p.inv_dir[axis];
        if (t < exit) {
            exit = t;
            through = axis;
        }
    }
    if (through < 0 || exit >= p.ray.t_max)
        return kBehindGrid;
    at[through] += p.ray.dir[through] > 0 ? 1u : ~0u;
    return at[through] < grid.count[through] ? number_of(grid, at) : kBehindGrid;
}

} // namespace ovc::thesis
