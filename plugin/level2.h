// SPDX-License-Identifier: Apache-2.0
// Cuts a soup into leaves whose pages fit the budget, and builds the pages.
#pragma once

#include "core/result.h"
#include "gpu/page.h"
#include "kdtree/partition.h"

#include <cstdint>
#include <vector>

namespace ovc {

struct Levels {
    Level1 level1;
    std::vector<Page> pages; // pages[i] belongs to level1.leaves[i]
    double seconds_level1 = 0;
    double seconds_level2 = 0;
};

/// Leaves of at most leaf_triangles (> 0), and fewer where a page would otherwise exceed
/// page_bytes. Error: a page of a single triangle does not fit.
Result<Levels> build_levels(const Soup& soup, const Numbering& numbers,
                            std::span<const TriangleId> triangles, const Box& bounds,
                            uint64_t leaf_triangles, uint64_t page_bytes);

} // namespace ovc
