// SPDX-License-Identifier: Apache-2.0
// The polygons of which tiling.cpp makes tilings.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

/// A point with the coordinates (x + x_roots root) / 2 and (z + z_roots root) / 2.
struct TileCorner {
    int8_t x, x_roots, z, z_roots;
};

/// A convex polygon, whose corners go round from x to z.
struct TileShape {
    int level; // of the tile's class: its share of the values begins at level / levels
    std::vector<TileCorner> corners;
};

/// The tiles of one period.
struct TilingShape {
    int levels;          // the number of classes of tiles
    double flat_from;    // the distance from its edges where a tile becomes flat
    double root;         // that the corners are counted in
    TileCorner sides[2]; // of the period
    std::vector<TileShape> tiles;
};

/// number: 1 to kTilings.
const TilingShape& tiling_shape(size_t number);

} // namespace ovc
