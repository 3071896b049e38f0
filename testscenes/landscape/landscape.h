// SPDX-License-Identifier: Apache-2.0
// landscape-N: hills with stones, of N million triangles. It is made tile by tile, so that a scene
// of any size can be written by a program that holds a few tiles.
#pragma once

#include "core/file/triangle_sink.h"
#include "core/scene.h"
#include "testscenes/corners.h"

#include <cstdint>

namespace ovc {

/// The most millions of a scene that is held, and of one that streams.
inline constexpr uint32_t kMaxLandscapeHeld = 100;
inline constexpr uint32_t kMaxLandscape = 4000;

/// Tiles are unit squares that lie row by row around the origin. Neighbours share the corners of
/// their ground bit for bit.
class Landscape {
public:
    static constexpr uint32_t kTilesAMillion = 40;
    static constexpr uint32_t kCells = 100;                           // along each side of a tile
    static constexpr uint32_t kGroundTriangles = 2 * kCells * kCells; // of a tile
    static constexpr uint32_t kStoneTriangles = 1'000'000 / kTilesAMillion - kGroundTriangles;

    explicit Landscape(uint32_t millions);

    uint32_t tiles() const { return columns_ * rows_; }
    uint32_t columns() const { return columns_; }

    /// Returns the corners of a tile's ground, kGroundTriangles of them.
    Corners ground(uint32_t tile) const;
    /// Returns the corners of the stones that lie on a tile, kStoneTriangles of them.
    Corners stones(uint32_t tile) const;

    /// Returns the scene without its two meshes' triangles: ground, stones.
    Scene empty_scene() const;

    /// Hands all triangles to the sink, and returns whether it wanted all of them.
    bool write(TriangleSink& sink) const;

private:
    /// Returns the ground's height at a point.
    static double height(dvec2 at);
    dvec2 corner_of(uint32_t tile) const;

    uint32_t columns_;
    uint32_t rows_;
};

} // namespace ovc
