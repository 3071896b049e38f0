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

/// A level-1 leaf. A hit counts inside `box` only: every triangle that touches the padded cell is
/// listed, and `box` is the part of the padded cell that they touch.
struct Leaf {
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
    double smallest_padding = 0; // of any cell

    uint64_t reference_count() const;
};

/// Cuts `triangles` of the soup, which lie in `bounds`, into leaves of at most max_leaf_triangles
/// (> 0).
Level1 partition(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
                 uint32_t max_leaf_triangles);

} // namespace ovc
