// SPDX-License-Identifier: Apache-2.0
// Cuts a soup into leaves whose pages fit the budget, and builds the pages.
#pragma once

#include "core/build_progress.h"
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

/// What leaves may be: so many triangles at most (> 0), and so many bytes of a page.
struct LeafLimits {
    uint64_t triangles;
    uint64_t page_bytes;

    /// Whether a page could be too large at all: else triangles alone decide.
    bool pages_matter() const;
    /// How many triangles a leaf may have for its page to fit where one takes so many bytes. At
    /// least 1.
    uint32_t triangles_at(double bytes_per_triangle) const;
    /// The same for the parts of a leaf whose page was too large; less than it had.
    uint32_t triangles_again(uint64_t triangles_before, uint64_t bytes_before) const;
};

/// Leaves within the limits; one whose page turns out too large is cut further. Error: a page of a
/// single triangle does not fit.
Result<Levels> build_levels(const Soup& soup, const Numbering& numbers,
                            std::span<const TriangleId> triangles, const Box& bounds,
                            const LeafLimits& limits, BuildProgress* progress = nullptr);

} // namespace ovc
