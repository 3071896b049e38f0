// SPDX-License-Identifier: Apache-2.0
// A BVH as level 1: it is an array in depth-first order, and a ray keeps the entry that it has
// reached. Its leaves do not come in the order of the ray. Based on: thesis, sections 3.3 and 3.4.
#pragma once

#include "gpu/bvh/bvh.h"
#include "kdtree/restart.h"
#include "plugin/overcast.h"
#include "plugin/thesis/level1/goldsmith_salmon.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc::thesis {

struct BvhEntry {
    Box box;         // holds the boxes of all leaves below
    uint32_t behind; // the entry to go on with where the ray misses the box
    uint32_t leaf;   // kNone: an inner node, whose first child is the next entry
};

/// A complete hierarchy over the triangles of a soup, to be cut off at any size of leaves. The soup
/// must outlive it.
class CompleteBvh {
public:
    /// Top-down, it uses the surface-area heuristic; bottom-up, Goldsmith and Salmon's insertion.
    CompleteBvh(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                ovc_level1_build build, BuildProgress* progress = nullptr);

    /// Returns level 1 with leaves of at most max_leaf_triangles (> 0), each triangle in one of
    /// them, and fills `entries`. Bottom-up, siblings that are small enough together become one
    /// leaf. The nodes of level 1 are one cell that names all leaves.
    Level1 cut(uint32_t max_leaf_triangles, std::vector<BvhEntry>& entries) const;

private:
    const Soup& soup_;
    std::vector<TriangleId> triangles_;
    Box bounds_;
    std::vector<BvhNode> nodes_; // top-down; an item is an index into triangles_
    InsertionTree insertion_;    // bottom-up
};

/// Returns the next leaf whose boxes the ray meets, from entry `index` on, and moves `index` past
/// it; leaf == kNone when there is none. A walk starts with 0. Needs can_walk().
Visit next_in_bvh(std::span<const BvhEntry> entries, const PreparedRay& p, uint32_t& index);

} // namespace ovc::thesis
