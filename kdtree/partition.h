// SPDX-License-Identifier: Apache-2.0
// Level 1: the soup cut into leaves by triangle count, each with a padded box and a frame of its
// own. Based on: thesis, section 3.3 (algorithm 2).
#pragma once

#include "core/soup.h"
#include "kdtree/tree.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// Maps a leaf's surroundings to [-1, 1]: local = (world - origin) * scale. The scale is a power of
/// two, so only the final rounding to float loses anything.
struct Frame {
    dvec3 origin{0};
    double scale = 1;

    dvec3 to_local(const dvec3& world) const { return (world - origin) * scale; }
};

/// A level-1 leaf. Every triangle that touches `cell` is listed. `box` holds the part of the cell
/// that they reach, and a margin around it: within it rays are traced, so that what is hit in the
/// cell is clear of the ends of the ray's stretch. A hit counts only where the ray is in the cell;
/// beyond, nearer triangles may be in the next leaf.
struct Leaf {
    Box cell;
    Box box;
    Frame frame;
    std::vector<TriangleId> triangles; // sorted
};

/// nodes' leaves name ranges of `leaves`: no leaf where a cell is empty, several where a cell
/// cannot be cut further.
struct Level1 {
    std::vector<KdNode> nodes;
    std::vector<Leaf> leaves;
    Box bounds;
    double padding =
        0; // of every cell, so that what rounding moves across a plane is on both sides

    uint64_t reference_count() const;
};

/// All of `triangles`, which lie in `bounds`, as one leaf.
Leaf whole_leaf(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds);

/// Cuts `triangles` of the soup, which lie in `bounds`, into leaves of at most max_leaf_triangles
/// (> 0).
Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles);

} // namespace ovc
