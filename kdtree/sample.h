// SPDX-License-Identifier: Apache-2.0
// A sample of a soup: enough triangles to choose level 1's planes by, which need not look at all.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// How many of `triangles` one of a sample stands for where leaves of at most leaf_triangles are
/// cut: a power of two; 1, all of them, where there are few in all or in a leaf.
uint32_t sample_rate(uint64_t triangles, uint64_t leaf_triangles);

/// About one in `rate` (a power of two) of the triangles, in order: those whose corners hash to it.
/// So a triangle is in the sample or not whatever else is there, and of duplicates all are or none.
/// A triangle is a unit of progress.
std::vector<TriangleId> sample_triangles(const Soup& soup, std::span<const TriangleId> triangles,
                                         uint32_t rate, BuildProgress* progress = nullptr);

/// What sample_triangles() has drawn of some triangles at a rate. rate 0: nothing.
struct Sample {
    std::span<const TriangleId> triangles;
    uint32_t rate = 0;
};

} // namespace ovc
