// SPDX-License-Identifier: Apache-2.0
// A bounding volume hierarchy by insertion: triangles come one after another, and each goes where
// it costs least. Based on: Goldsmith and Salmon 1987, "Automatic Creation of Object Hierarchies
// for Ray Tracing"; thesis, chapter 4 (of ten shuffled orders, the tree of min cost is kept).
#pragma once

#include "core/box.h"
#include "core/build_progress.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc::thesis {

struct InsertionNode {
    Boxf box;
    uint32_t parent;
    uint32_t first_child; // inner; children are linked by next_sibling
    uint32_t next_sibling;
    uint32_t children; // 0: a leaf
    uint32_t item;     // leaf: index of the box
    uint32_t items;    // leaves below, itself included
};

/// nodes[0] is the root, an inner node even above one leaf; without boxes there are no nodes.
struct InsertionTree {
    std::vector<InsertionNode> nodes;
    /// The mean number of children that a ray which meets the root is tested against. Goldsmith and
    /// Salmon minimise this.
    double cost = 0;
};

/// Returns the tree by inserting boxes[order[0]], boxes[order[1]], … (none of them empty). A box is
/// a unit of progress.
InsertionTree insert_in_order(std::span<const Boxf> boxes, std::span<const uint32_t> order,
                              BuildProgress* progress = nullptr);

/// Returns the tree of min cost of `shuffles` (> 0) random orders, the same on every run.
InsertionTree best_insertion_tree(std::span<const Boxf> boxes, int shuffles,
                                  BuildProgress* progress = nullptr);

} // namespace ovc::thesis
