// SPDX-License-Identifier: Apache-2.0
// The CPU KDT: nearest hits and occlusion in double over a full tree, many rays a call. What it
// answers is, bit for bit, what testing every triangle with core/exact/triangle.h answers. Based
// on: Pharr and Humphreys 2004, section 4.4 (traversal); thesis, chapter 4 (the interface for many
// rays).
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/tree.h"

#include <span>

namespace ovc {

/// The nearest hit of one ray, ties to the smaller id; a miss for an invalid ray.
Hit intersect(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip = {});

/// True when the ray hits anything.
bool occluded(const KdTree& tree, const Soup& soup, const Ray& ray, TriangleId skip = {});

/// hits[i] for rays[i], on all cores. skip: empty, or one triangle per ray that it does not see.
void intersect(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
               std::span<const TriangleId> skip, std::span<Hit> hits);

/// occluded[i] = 1 or 0 for rays[i], on all cores.
void occluded(const KdTree& tree, const Soup& soup, std::span<const Ray> rays,
              std::span<const TriangleId> skip, std::span<uint8_t> occluded);

} // namespace ovc
