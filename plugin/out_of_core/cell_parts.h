// SPDX-License-Identifier: Apache-2.0
// Cells of level 1 that hold too many triangles to be built at once, dealt again to parts.
#pragma once

#include "plugin/out_of_core/dealt_cells.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>
#include <span>

namespace ovc {

/// Returns how many parts a cell of so many triangles has. 0: it is built whole.
size_t parts_of_cell(uint64_t triangles, uint64_t max_triangles);

/// Deals each triangle of the cell to one of `parts` (> 0) cells of `to`, from `first` on, so that
/// all of them hold about as many, neighbours mostly together, and duplicates too unless they fill
/// a part by themselves. Which part a triangle is dealt to depends on the cell's triangles alone.
void deal_to_parts(const DealtCells& from, size_t cell, std::span<const SourceMesh> meshes,
                   DealtCells& to, size_t first, size_t parts);

} // namespace ovc
