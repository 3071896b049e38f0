// SPDX-License-Identifier: Apache-2.0
// Builds a KD-tree over a soup by the surface-area heuristic: the full tree of the CPU KDT, or
// level 1, where it stops at a triangle count. Based on: MacDonald and Booth 1990; Wald and Havran
// 2006, sections 3-4; Shevtsov et al. 2007, section 4 (binning); Hurley et al. 2002 (clipped bounds
// at splits).
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"
#include "kdtree/tree.h"

#include <cstdint>
#include <span>

namespace ovc {

struct KdBuildOptions {
    /// 0: split as long as the heuristic says that it pays (the CPU KDT). Else: split cells of more
    /// triangles while a split helps, others where it saves three quarters of the work (level 1).
    uint32_t max_leaf_triangles = 0;
    /// By how much cells are padded afterwards, in level 1. Triangles that are closer to a plane
    /// count on both sides of it.
    double padding = 0;
    uint32_t stands_for = 1;    // each given triangle stands for so many; multiplies counts
    double traversal_cost = 15; // Wald and Havran 2006, section 5.1
    double intersection_cost = 20;
    double empty_bonus = 0.8;          // factor on the cost of a split that cuts off empty space
    BuildProgress* progress = nullptr; // asked whether to stop
};

/// Returns the tree over all hittable triangles of the soup.
KdTree build_kd_tree(const Soup& soup, const KdBuildOptions& options = {});

/// Returns the tree over hittable `triangles` of the soup, without those outside of `bounds`.
KdTree build_kd_tree(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                     const KdBuildOptions& options);

} // namespace ovc
