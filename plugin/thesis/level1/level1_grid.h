// SPDX-License-Identifier: Apache-2.0
// A uniform grid as level 1. A ray keeps the number of the cell it is in, and goes on from there.
// Based on: thesis, section 3.4; Amanatides and Woo 1987.
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/partition.h"

#include <array>
#include <cstdint>
#include <vector>

namespace ovc::thesis {

struct Grid {
    /// The leaves [first, end) of level 1: none where the cell is empty, several where it holds
    /// more triangles than a leaf may.
    struct Cell {
        uint32_t first = 0;
        uint32_t end = 0;
    };

    Box bounds;
    std::array<uint32_t, 3> count{1, 1, 1}; // cells along each axis
    std::vector<Cell> cells;                // x fastest

    uint32_t cell_count() const { return count[0] * count[1] * count[2]; }
    /// Returns where cell i of an axis begins and cell i - 1 ends.
    double plane(int axis, uint32_t i) const;
    /// Returns the number of the cell that holds a point, or of the nearest one.
    uint32_t cell_at(const dvec3& point) const;
};

/// Makes a grid over `triangles` of the soup, which lie in `bounds`, and returns its cells as
/// leaves of at most max_leaf_triangles (> 0). It is the coarsest whose cells all hold so few, by
/// their centres; where triangles crowd, it has kMaxCellsPerLeaf cells for each leaf that would do.
Level1 cut_into_grid(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                     uint32_t max_leaf_triangles, Grid& grid);

inline constexpr uint64_t kMaxCellsPerLeaf = 64;

inline constexpr uint32_t kBeforeGrid = 0xffffffffu; // the ray has not begun
inline constexpr uint32_t kBehindGrid = 0xfffffffeu; // no cell is left

/// Returns the first cell of the ray where `cell` is kBeforeGrid, else the one behind `cell`;
/// kBehindGrid when there is none. Needs can_walk().
uint32_t next_cell(const Grid& grid, double padding, const PreparedRay& p, uint32_t cell);

} // namespace ovc::thesis
