// SPDX-License-Identifier: Apache-2.0
// Cubes: parts of a scene from which the bytes of its pages are estimated.
#pragma once

#include "core/soup.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

inline constexpr size_t kInASmallCube = 512; // triangles at most
// In cubes of this size planes cut triangles as often as in pages.
inline constexpr size_t kInALargeCube = 8192;

/// They lie around triangles of a sample, so there are many where there are many triangles.
struct Cubes {
    std::vector<Box> small;
    size_t in_small = 0; // triangles that each of these is made for
    std::vector<Box> large;
};

/// sample: triangles of the soup, not empty, each for `rate` (> 0) of `triangles` (> 0) in all.
Cubes choose_cubes(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                   uint64_t triangles);

/// A grid around some cubes, with a bit in each cell for every cube that reaches into it.
class CubeGrid {
public:
    /// cubes: at most 64, which outlive the grid.
    explicit CubeGrid(std::span<const Box> cubes);

    /// Returns a bit for each cube that the triangle touches. Any number of threads may call it.
    uint64_t touched(const Triangle& triangle) const;

private:
    uint64_t near_to(const Box& box) const;
    int cell_of(double x, int axis) const;
    template <class Visit>
    void each_cell(const Box& box, Visit&& visit) const;

    std::span<const Box> cubes_;
    Box bounds_;
    dvec3 scale_;
    std::vector<uint64_t> cells_;
};

} // namespace ovc
