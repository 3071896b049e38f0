// SPDX-License-Identifier: Apache-2.0
// The smallest budget that works: told by counts alone, so that plan and commit say the same before
// anything is built, and every larger one works as well.
#pragma once

#include "gpu/egl_context.h"

#include <cstdint>

namespace ovc {

/// Of a page in which planes cut nothing: a unit a triangle, and a node above every two.
inline constexpr uint64_t kMaxUncutBytesPerTriangle = 128;

/// How a scene is cut where hardly anything fits: leaves by count (kdtree/partition.h), all of them
/// about as large as level 1's table is, which takes the least together.
struct SmallestCut {
    uint32_t leaf_triangles = 1;
    uint64_t pool_bytes = 0; // that the table and the largest page take, at most
};

/// triangles: that are added, whether they can be hit or not. max_leaf_triangles: 0: any.
SmallestCut smallest_cut(uint64_t triangles, uint64_t max_leaf_triangles, bool tell_active);

/// The smallest budget that leaves so much to the pool.
uint64_t smallest_budget(uint64_t pool_bytes, const DeviceInfo& device);

} // namespace ovc
