// SPDX-License-Identifier: Apache-2.0
// one_leaf_pays(): tells whether a scene that could be one leaf should be.
#pragma once

#include "core/soup.h"

#include <cstdint>
#include <span>

namespace ovc {

/// Whether rays do better in one leaf of all triangles than in leaves of at most
/// max_leaf_triangles (> 0): where the planes of level 1 are a worse top for the tree than those
/// that the surface-area heuristic chooses, or cut many triangles, which planes within a page do
/// with more care. Trees over a sample tell, each triangle of which stands for `rate`
/// (kdtree/sample.h). bounds: the box of all triangles.
bool one_leaf_pays(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                   const Box& bounds, uint32_t max_leaf_triangles);

} // namespace ovc
