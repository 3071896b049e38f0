// SPDX-License-Identifier: Apache-2.0
// A peer for the bench: a KD-tree such as renderers on the CPU have, in float32, one ray at a time.
// It shows how fast such a tree is; its answers are not certified. Based on: Pharr and Humphreys
// 2010, section 4.4 (8-byte nodes, traversal); Moeller and Trumbore 1997 (triangles).
#pragma once

#include "host/backend/backend.h"
#include "kdtree/tree.h"

namespace ovc {

/// Returns a backend that has copied what it needs of the soup and of `tree`, which
/// build_kd_tree() made over the soup; neither needs to outlive it. Its statistics count no time to
/// build.
std::unique_ptr<Backend> make_float_kd_backend(const Soup& soup, const KdTree& tree);

} // namespace ovc
