// SPDX-License-Identifier: Apache-2.0
// A peer for the bench: a KD-tree as a renderer on the CPU has it, in float32, one ray at a time.
// Nothing is certified; it is as fast as that is, not as right. Based on: Pharr and Humphreys 2010,
// section 4.4 (8-byte nodes, traversal); Moeller and Trumbore 1997 (triangles).
#pragma once

#include "host/backend/backend.h"
#include "kdtree/tree.h"

namespace ovc {

/// tree: of build_kd_tree() over the soup; it may go afterwards. Its time to build is not counted.
std::unique_ptr<Backend> make_float_kd_backend(const Soup& soup, const KdTree& tree);

} // namespace ovc
