// SPDX-License-Identifier: Apache-2.0
// build_cell() makes leaves and pages of the triangles of one cell of level 1, by themselves.
#pragma once

#include "core/build_progress.h"
#include "core/duplicates.h"
#include "core/result.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"
#include "plugin/build/built_scene.h"
#include "plugin/out_of_core/local_soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Options that are the same for all cells.
struct CellOptions {
    Box bounds; // of the scene
    uint32_t max_triangles = 1;
    CellCut cut = CellCut::InOrder;
    uint64_t max_page_bytes = 0;
    std::span<const uint32_t> first_numbers; // of each mesh, in pages
    LoosePairs loose;
};

struct BuiltCell {
    std::vector<KdNode> nodes; // the tree over the cell, whose leaf nodes name leaves from 0
    std::vector<Leaf> leaves;  // which list names, not local ids
    std::vector<Page> pages;
    std::vector<Duplicates::Pair> duplicates; // by names
};

/// Builds the cell `box`. planned: has the frame and the grid of all its leaves. Error: a page of
/// one triangle is too large.
Result<BuiltCell> build_cell(const LocalSoup& soup, const Box& box, const Leaf& planned,
                             const CellOptions& options, BuildProgress* progress);

} // namespace ovc
