// SPDX-License-Identifier: Apache-2.0
// The uniform grid: puts triangles into cells, and cells into texels.
#include "plugin/thesis/grid.h"

#include "kdtree/clip.h"
#include "plugin/thesis/references.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::thesis {
namespace {

constexpr double kCellsPerTriangle = 5;
constexpr double kMaxCells = 1024; // per axis: cells stay hundreds of times as wide as kWider

/// The places of the planes, in the floats and the arithmetic of the kernel.
struct Planes {
    vec3 lo;
    vec3 size;
    std::array<uint32_t, 3> count;

    Planes(const Box& box, uint64_t triangles)
        : lo(box.lo), count(grid_resolution(box.extent(), triangles)) {
        for (int axis = 0; axis < 3; ++axis)
            size[axis] = float(box.extent()[axis] / count[axis]);
    }

    double plane(int axis, uint32_t i) const {
        return double(lo[axis]) + double(i) * double(size[axis]);
    }
    /// Returns the cell at x, or the nearest one.
    uint32_t cell(int axis, double x) const {
        const double at = std::floor((x - double(lo[axis])) / double(size[axis]));
        return uint32_t(std::clamp(at, 0.0, double(count[axis] - 1)));
    }
    uint32_t index(const std::array<uint32_t, 3>& cell) const {
        assert(cell[0] < count[0] && cell[1] < count[1] && cell[2] < count[2]);
        return (cell[2] * count[1] + cell[1]) * count[0] + cell[0];
    }
    /// Returns the box from the lower corner of cell `from` to the upper one of `to`.
    Box block(const std::array<uint32_t, 3>& from, const std::array<uint32_t, 3>& to) const {
        return {{plane(0, from[0]), plane(1, from[1]), plane(2, from[2])},
                {plane(0, to[0] + 1), plane(1, to[1] + 1), plane(2, to[2] + 1)}};
    }
    uint64_t cells() const { return uint64_t(count[0]) * count[1] * count[2]; }
};

using Cell = std::array<uint32_t, 3>;

/// Appends the cells of the block [from, to] that the triangle touches; it touches the block. The
/// block is halved, because a large triangle comes near few of its box's cells.
void find_cells(const Planes& planes, const Triangle& triangle, uint32_t id, const Cell& from,
                const Cell& to, std::vector<Reference>& out) {
    int axis = 0;
    for (int other = 1; other < 3; ++other)
        if (to[other] - from[other] > to[axis] - from[axis])
            axis = other;
    if (from[axis] == to[axis]) {
        out.push_back({planes.index(from), id});
        return;
    }
    const uint32_t middle = (from[axis] + to[axis]) / 2;
    Cell below = to, above = from;
    below[axis] = middle;
    above[axis] = middle + 1;
    for (const auto& [first, last] : {std::pair(from, below), {above, to}})
        if (!clipped_bounds(triangle, planes.block(first, last).padded(kWider)).empty())
            find_cells(planes, triangle, id, first, last, out);
}

void find_cells(const Planes& planes, const LocalTriangle& local, uint32_t id,
                std::vector<Reference>& out) {
    const Triangle triangle = {dvec3(local[0]), dvec3(local[1]), dvec3(local[2])};
    const Box box = bounds_of(triangle).padded(kWider);
    Cell from, to;
    for (int axis = 0; axis < 3; ++axis) {
        from[axis] = planes.cell(axis, box.lo[axis]);
        to[axis] = planes.cell(axis, box.hi[axis]);
    }
    find_cells(planes, triangle, id, from, to, out);
}

System pack(const Planes& planes, const References& references,
            const std::vector<LocalTriangle>& triangles) {
    assert(references.first.size() == planes.cells() + 1);
    System system;
    Texels& texels = system.texels;
    texels = {texel(planes.lo),
              texel(planes.size),
              {planes.count[0], planes.count[1], planes.count[2], 0},
              uvec4(0)};
    const uint32_t cells = uint32_t(texels.size());
    for (uint64_t c = 0; c < planes.cells(); c += 2) {
        const std::vector<uint32_t>& first = references.first;
        const bool second = c + 1 < planes.cells();
        texels.push_back(
            {first[c], first[c + 1], second ? first[c + 1] : 0, second ? first[c + 2] : 0});
    }
    const uint32_t lists = uint32_t(texels.size());
    append(texels, references.triangles);
    texels[3] = {cells, lists, uint32_t(texels.size()), 0};
    for (uint32_t i = 0; i < triangles.size(); ++i)
        append(texels, triangles[i], i);
    system.references = references.triangles.size();
    return system;
}

} // namespace

std::array<uint32_t, 3> grid_resolution(const dvec3& extent, uint64_t triangles) {
    assert(triangles > 0);
    const double volume = extent.x * extent.y * extent.z;
    const double per_length = std::cbrt(kCellsPerTriangle * double(triangles) / volume);
    std::array<uint32_t, 3> cells;
    for (int axis = 0; axis < 3; ++axis)
        cells[axis] = uint32_t(std::clamp(std::round(extent[axis] * per_length), 1.0, kMaxCells));
    return cells;
}

Result<System> build_grid(const Soup& soup, const Leaf& whole, BuildProgress* progress) {
    const std::vector<LocalTriangle> triangles = local_triangles(soup, whole);
    const Planes planes({whole.frame.to_local(whole.box.lo), whole.frame.to_local(whole.box.hi)},
                        triangles.size());
    const References references = gather_references(
        triangles.size(), planes.cells(), progress,
        [&](uint32_t i, std::vector<Reference>& out) { find_cells(planes, triangles[i], i, out); });
    return pack(planes, references, triangles);
}

} // namespace ovc::thesis
