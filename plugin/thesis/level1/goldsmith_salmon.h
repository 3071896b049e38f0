// SPDX-License-Identifier: Apache-2.0
// A bounding volume hierarchy by insertion: triangles come one after another, and each goes where
// it costs least. Based on: Goldsmith and Salmon 1987, "Automatic Creation of Object Hierarchies
// for Ray Tracing"; thesis, chapter 4 (ten shuffled orders, the least cost kept).
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

/// nodes[0] is the root and inner, whatever it holds; no nodes: no boxes.
struct InsertionTree {
    std::vector<InsertionNode> nodes;
    /// Children that a ray which meets the root is tested against, on average: what Goldsmith and
    /// Salmon minimise.
    double cost = 0;
};

/// The tree by inserting boxes[order[0]], boxes[order[1]], … (none of them empty). A box
/// is a unit of progress.
InsertionTree insert_in_order(std::span<const Boxf> boxes, std::span<const uint32_t> order,
                              BuildProgress* progress = nullptr);

/// The one of least cost over `shuffles` (> 0) random orders, the same on every run.
InsertionTree best_insertion_tree(std::span<const Boxf> boxes, int shuffles,
                                  BuildProgress* progress = nullptr);

} // namespace ovc::thesis
