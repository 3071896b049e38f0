// SPDX-License-Identifier: Apache-2.0
// Samples of a soup, from which level 1's planes are chosen without looking at all triangles.
#pragma once

#include "core/build_progress.h"
#include "core/soup.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Returns the number of `triangles` per triangle of a sample where leaves of at most
/// leaf_triangles are cut: a power of two; 1, so all, where there are few in all or in a leaf.
uint32_t sample_rate(uint64_t triangles, uint64_t leaf_triangles);

/// Returns about one in `rate` (a power of two) of the triangles, in order: those that their
/// corners' hash selects. So whether a triangle is in the sample does not depend on the others, and
/// of duplicates all are or none. A triangle is a unit of progress.
std::vector<TriangleId> sample_triangles(const Soup& soup, std::span<const TriangleId> triangles,
                                         uint32_t rate, BuildProgress* progress = nullptr);

/// The triangles that sample_triangles() has drawn at a rate. rate 0: nothing was drawn.
struct Sample {
    std::span<const TriangleId> triangles;
    uint32_t rate = 0;
};

} // namespace ovc
