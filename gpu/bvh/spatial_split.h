// SPDX-License-Identifier: Apache-2.0
// Spatial splits: a plane cuts the items in a node's boxes, and items that it cuts are in both
// halves. Based on: Stich, Friedrich and Dietrich 2009, "Spatial Splits in Bounding Volume
// Hierarchies".
#pragma once

#include "gpu/bvh/bvh_items.h"
#include "gpu/bvh/pairs.h"

#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

struct SpatialSplit {
    float cost = std::numeric_limits<float>::infinity(); // area x items, the sum of both sides
    int axis = -1;
    float plane = 0;
    Bounds below;
    Bounds above;
    uint32_t below_count = 0;
    uint32_t above_count = 0;
};

/// Returns about the cheapest plane through a node's items, of 15 across each axis, that adds at
/// most `max_added` of them; the cost is infinite if there is none. A sample of the items decides,
/// and boxes stand for their contents. bounds: of all the items.
SpatialSplit best_spatial_split(std::span<const Item> items, const Bounds& bounds,
                                size_t max_added);

struct Halves {
    std::vector<Item> below;
    std::vector<Item> above;

    float cost() const; // like SpatialSplit::cost, of the actual halves
};

/// Hands the items, whose indices name `pairs`, to the sides of the plane. An item that the plane
/// cuts goes to one side whole if that is cheaper, or if `max_added` are added already.
Halves divide_by_plane(std::span<const Item> items, const SpatialSplit& split,
                       std::span<const TrianglePair> pairs, size_t max_added);

} // namespace ovc
