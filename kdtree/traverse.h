// SPDX-License-Identifier: Apache-2.0
// The CPU KDT: nearest hits and occlusion in double over a full tree, many rays a call. Its answers
// are, bit for bit, those of testing every triangle with core/exact/triangle.h. Based on: Pharr and
// Humphreys 2004, section 4.4 (traversal); thesis, chapter 4 (the interface for many rays).
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/tree.h"

#include <span>

namespace ovc {

/// Returns the nearest hit of one ray, ties to the smaller id; a miss for an invalid ray. Hits that
/// `without` excludes, or that do not pass the sieve, do not count.
Hit intersect(const KdTree& tree, const Soup& soup, const Ray& ray, const Exclusion& without = {},
              const RaySieve& sieve = {});

/// Returns true when the ray hits anything; false for an invalid ray.
bool occluded(const KdTree& tree, const Soup& soup, const Ray& ray, const Exclusion& without = {},
              const RaySieve& sieve = {});

/// Writes the nearest hit of rays[i] to hits[i], on all cores.
void intersect(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
               const Exclusions& without, std::span<Hit> hits);

/// Writes 1 to occluded[i] where rays[i] hits anything, else 0, on all cores.
void occluded(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
              const Exclusions& without, std::span<uint8_t> occluded);

} // namespace ovc
