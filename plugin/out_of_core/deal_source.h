// SPDX-License-Identifier: Apache-2.0
// deal_source() goes through all triangles of a source once more, and deals them to the cells that
// they touch.
#pragma once

#include "core/build_progress.h"
#include "kdtree/cells.h"
#include "plugin/out_of_core/dealt_cells.h"
#include "plugin/structure/triangle_source.h"

#include <span>

namespace ovc {

/// dealt: has a cell for each of the finder's, and one behind them, which gets those of `far`,
/// which are sorted; where there are none, the triangles that touch many cells, if these are worth
/// a leaf of their own (far_leaf_pays). hittable: the number of triangles that can be hit. A
/// triangle is a unit of progress.
void deal_source(TriangleSource& source, const CellFinder& finder, std::span<const TriangleId> far,
                 uint64_t hittable, uint64_t max_leaf_triangles, DealtCells& dealt,
                 BuildProgress* progress);

} // namespace ovc
