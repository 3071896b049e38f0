// SPDX-License-Identifier: Apache-2.0
// Level 1 on the CPU, as the thesis compares it: a KD-tree, a uniform grid or a BVH over the same
// kind of leaves, built from the top or from the bottom. Each ray keeps a state from which it goes
// on where it stopped. Based on: thesis, sections 3.3 (algorithm 2) and 3.4 (algorithm 4).
#pragma once

#include "kdtree/restart.h"
#include "plugin/overcast.h"
#include "plugin/thesis/level1/level1_bvh.h"
#include "plugin/thesis/level1/level1_grid.h"

#include <memory>
#include <vector>

namespace ovc::thesis {

/// The data that a walk of each kind needs besides the Level1 that all have.
struct Level1Walk {
    ovc_level1 kind = OVC_LEVEL1_KD_TREE; // walked in the nodes of Level1
    Grid grid;
    std::vector<BvhEntry> bvh;

    /// Returns whether a hit in a leaf's cell ends the walk; a BVH's leaves come in no order.
    bool along_the_ray() const { return kind != OVC_LEVEL1_BVH; }
};

/// The restart state of a ray.
struct RayPlace {
    RayPosition cells;      // KD-tree: all of it. Grid: leaves [next, end) of the cell are to come
    uint32_t index = kNone; // grid: the cell; BVH: the next entry; kNone: not begun
};

/// Returns the next leaf of the ray whose box it meets, and moves `place` past it; leaf == kNone
/// when there is none. Each leaf comes once, a BVH's in any order. Start with {{t_min}}. Needs
/// can_walk().
Visit next_leaf(const Level1Walk& walk, const Level1& level1, const PreparedRay& p,
                RayPlace& place);

/// Does the same, but returns no leaf beyond the cell of the last one. Not for a BVH.
Visit next_leaf_in_cell(const Level1& level1, const PreparedRay& p, RayPlace& place);

/// Builds level 1. It keeps whatever serves all sizes of leaves: a complete tree, to be merged.
class Level1Builder {
public:
    /// `triangles` of the soup lie in `bounds`; all three must outlive it. Grids are built
    /// top-down.
    Level1Builder(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                  ovc_level1 kind, ovc_level1_build build, BuildProgress* progress = nullptr);

    /// Returns level 1 with leaves of at most max_leaf_triangles (> 0), and fills `walk`.
    Level1 cut(uint32_t max_leaf_triangles, Level1Walk& walk) const;

private:
    const Soup& soup_;
    std::span<const TriangleId> triangles_;
    const Box& bounds_;
    ovc_level1 kind_;
    ovc_level1_build build_;
    BuildProgress* progress_;
    KdTree full_; // KD-tree, bottom-up
    std::unique_ptr<CompleteBvh> bvh_;
};

} // namespace ovc::thesis
