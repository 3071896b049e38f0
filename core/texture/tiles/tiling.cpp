// SPDX-License-Identifier: Apache-2.0
#include "core/texture/tiles/tiling.h"

#include "core/texture/tiles/tiling_table.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <vector>

namespace ovc {

namespace {

/// The half plane along the edge of a tile: its points p have dot(out, p) <= offset.
struct TileEdge {
    dvec2 out; // of length 1
    double offset;
};

struct PlacedTile {
    int level;
    std::vector<TileEdge> edges;

    /// Returns the distance to the nearest edge, below 0 outside.
    double depth_at(const dvec2& p) const {
        double depth = 1e300;
        for (const TileEdge& edge : edges)
            depth = std::min(depth, edge.offset - glm::dot(edge.out, p));
        return depth;
    }
};

/// A tiling with all copies of its tiles that reach into the period at the origin.
struct PlacedTiling {
    dvec2 sides[2];
    std::vector<PlacedTile> tiles;
};

dvec2 place_of(const TileCorner& corner, double root) {
    return 0.5 * dvec2(corner.x + corner.x_roots * root, corner.z + corner.z_roots * root);
}

PlacedTile placed_tile(const TileShape& shape, double root, const dvec2& shift) {
    PlacedTile tile{shape.level, {}};
    for (size_t i = 0; i < shape.corners.size(); ++i) {
        const dvec2 from = place_of(shape.corners[i], root) + shift;
        const dvec2 to = place_of(shape.corners[(i + 1) % shape.corners.size()], root) + shift;
        const dvec2 out = glm::normalize(dvec2(to.y - from.y, from.x - to.x));
        tile.edges.push_back({out, glm::dot(out, from)});
    }
    return tile;
}

/// Returns whether the boxes around the shape and around the period meet.
bool reaches_period(const TilingShape& tiling, const TileShape& shape, const dvec2& shift) {
    const dvec2 a = place_of(tiling.sides[0], tiling.root),
                b = place_of(tiling.sides[1], tiling.root);
    const dvec2 low = glm::min(glm::min(a, b), glm::min(dvec2(0), a + b));
    const dvec2 high = glm::max(glm::max(a, b), glm::max(dvec2(0), a + b));
    dvec2 shape_low(1e300), shape_high(-1e300);
    for (const TileCorner& corner : shape.corners) {
        shape_low = glm::min(shape_low, place_of(corner, tiling.root) + shift);
        shape_high = glm::max(shape_high, place_of(corner, tiling.root) + shift);
    }
    return glm::all(glm::lessThan(shape_low, high)) && glm::all(glm::lessThan(low, shape_high));
}

PlacedTiling placed_tiling(const TilingShape& tiling) {
    constexpr int kReach = 4; // periods around the one at the origin; tiles begin next to it
    PlacedTiling placed;
    for (size_t i = 0; i < 2; ++i)
        placed.sides[i] = place_of(tiling.sides[i], tiling.root);
    for (int i = -kReach; i <= kReach; ++i)
        for (int j = -kReach; j <= kReach; ++j) {
            const dvec2 shift = double(i) * placed.sides[0] + double(j) * placed.sides[1];
            for (const TileShape& shape : tiling.tiles)
                if (reaches_period(tiling, shape, shift))
                    placed.tiles.push_back(placed_tile(shape, tiling.root, shift));
        }
    return placed;
}

const PlacedTiling& placed_tiling(size_t number) {
    static const std::vector<PlacedTiling> all = [] {
        std::vector<PlacedTiling> placed;
        for (size_t i = 1; i <= kTilings; ++i)
            placed.push_back(placed_tiling(tiling_shape(i)));
        return placed;
    }();
    return all[number - 1];
}

/// Returns the same point of the period at the origin.
dvec2 in_first_period(const PlacedTiling& tiling, const dvec2& at) {
    const dvec2 &a = tiling.sides[0], &b = tiling.sides[1];
    const double area = a.x * b.y - a.y * b.x;
    const double along_a = (at.x * b.y - at.y * b.x) / area;
    const double along_b = (a.x * at.y - a.y * at.x) / area;
    return at - std::floor(along_a) * a - std::floor(along_b) * b;
}

} // namespace

double tiling(size_t number, const dvec3& at) {
    assert(number >= 1 && number <= kTilings);
    const TilingShape& shape = tiling_shape(number);
    const PlacedTiling& placed = placed_tiling(number);
    const dvec2 p = in_first_period(placed, dvec2(at.x, at.z));
    double depth = -1e300;
    int level = 0;
    for (const PlacedTile& tile : placed.tiles)
        if (const double own = tile.depth_at(p); own > depth) {
            depth = own;
            level = tile.level;
        }
    const double from_edge = std::clamp(depth / shape.flat_from, 0.0, 1.0);
    // At a place of a map that begins a class of flat tiles, povray's values count as beyond it.
    constexpr double kBeyond = 1e-9;
    return std::min(1.0, (level + 1 - from_edge) / shape.levels + kBeyond);
}

} // namespace ovc
