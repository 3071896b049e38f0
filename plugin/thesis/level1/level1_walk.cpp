// SPDX-License-Identifier: Apache-2.0
// The three kinds of level 1 behind one call each.
#include "plugin/thesis/level1/level1_walk.h"

#include "kdtree/build.h"
#include "plugin/thesis/level1/merge_leaves.h"

#include <cassert>

namespace ovc::thesis {
namespace {

Visit next_in_grid(const Grid& grid, const Level1& level1, const PreparedRay& p, RayPlace& place) {
    while (true) {
        if (const Visit visit = next_leaf_in_cell(level1, p, place); visit.leaf != kNone)
            return visit;
        if (place.index == kBehindGrid)
            return {};
        place.index = next_cell(grid, level1.padding, p, place.index);
        if (place.index == kBehindGrid)
            return {};
        assert(place.index < grid.cells.size());
        const Grid::Cell& cell = grid.cells[place.index];
        place.cells.next = cell.first;
        place.cells.end = cell.end;
    }
}

} // namespace

Visit next_leaf(const Level1Walk& walk, const Level1& level1, const PreparedRay& p,
                RayPlace& place) {
    static_assert(kBeforeGrid == kNone);
    if (level1.leaves.empty())
        return {};
    switch (walk.kind) {
    case OVC_LEVEL1_GRID:
        return next_in_grid(walk.grid, level1, p, place);
    case OVC_LEVEL1_BVH:
        place.index = place.index == kNone ? 0 : place.index;
        return next_in_bvh(walk.bvh, p, place.index);
    default:
        return ovc::next_leaf(level1, p, place.cells);
    }
}

Visit next_leaf_in_cell(const Level1& level1, const PreparedRay& p, RayPlace& place) {
    return ovc::next_leaf_in_cell(level1, p, place.cells);
}

Level1Builder::Level1Builder(const Soup& soup, std::span<const TriangleId> triangles,
                             const Box& bounds, ovc_level1 kind, ovc_level1_build build,
                             BuildProgress* progress)
    : soup_(soup),
      triangles_(triangles),
      bounds_(bounds),
      kind_(kind),
      build_(build),
      progress_(progress) {
    assert(kind != OVC_LEVEL1_GRID || build == OVC_LEVEL1_BUILD_TOP_DOWN);
    if (kind == OVC_LEVEL1_BVH)
        bvh_ = std::make_unique<CompleteBvh>(soup, triangles, bounds, build, progress);
    else if (build == OVC_LEVEL1_BUILD_BOTTOM_UP)
        full_ = build_kd_tree(soup, triangles, bounds, {.progress = progress});
}

Level1 Level1Builder::cut(uint32_t max_leaf_triangles, Level1Walk& walk) const {
    assert(max_leaf_triangles > 0);
    walk.kind = kind_;
    if (kind_ == OVC_LEVEL1_GRID)
        return cut_into_grid(soup_, triangles_, bounds_, max_leaf_triangles, walk.grid);
    if (kind_ == OVC_LEVEL1_BVH)
        return bvh_->cut(max_leaf_triangles, walk.bvh);
    if (build_ == OVC_LEVEL1_BUILD_BOTTOM_UP)
        return fill_cells(soup_, triangles_, bounds_, merge_leaves(full_, max_leaf_triangles),
                          max_leaf_triangles);
    return partition(soup_, triangles_, bounds_, max_leaf_triangles, progress_);
}

} // namespace ovc::thesis
