// SPDX-License-Identifier: Apache-2.0
// Cubes are as large as it takes to hold a number of the sample's triangles.
#include "plugin/plan/cubes.h"

#include "core/system/parallel.h"
#include "kdtree/clip.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

constexpr size_t kMaxCubes = 64; // a word has a bit for each
constexpr size_t kLargeCubes = 4;
constexpr uint64_t kMinTriangles = 4096;
constexpr uint64_t kMaxTriangles = 32768;
constexpr int kSide = 32; // cells of a grid along each axis

/// Returns the cube around `center`, one of the centres, that holds `count` of them, on average.
Box cube_around(const dvec3& center, std::span<const dvec3> centers, double count,
                std::vector<double>& distances) {
    // A few tell how large it is; where it is to hold fewer, it is smaller, as on a surface.
    constexpr double kFew = 4;
    distances.resize(centers.size());
    std::transform(centers.begin(), centers.end(), distances.begin(),
                   [&](const dvec3& other) { return max_component(glm::abs(other - center)); });
    const auto nth =
        distances.begin() + ptrdiff_t(std::min(size_t(std::max(count, kFew)), centers.size()) - 1);
    std::nth_element(distances.begin(), nth, distances.end());
    const dvec3 half(*nth * std::sqrt(std::min(count / kFew, 1.0)));
    return {center - half, center + half};
}

std::vector<Box> cubes_around(std::span<const dvec3> centers, size_t cubes, double count) {
    std::vector<Box> chosen(cubes);
    parallel_for(cubes, 1, [&](size_t first, size_t last) {
        std::vector<double> distances;
        for (size_t c = first; c < last; ++c) {
            // Ids are evenly spread over a scene's parts, so each part gets its share of cubes.
            const size_t i = (2 * c + 1) * centers.size() / (2 * cubes);
            chosen[c] = cube_around(centers[i], centers, count, distances);
        }
    });
    return chosen;
}

} // namespace

Cubes choose_cubes(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                   uint64_t triangles) {
    assert(!sample.empty() && rate > 0);
    std::vector<dvec3> centers(sample.size());
    parallel_for(sample.size(), 4096, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Triangle t = soup.triangle(sample[i]);
            centers[i] = (t[0] + t[1] + t[2]) / 3.0;
        }
    });
    const uint64_t in_all = std::clamp<uint64_t>(triangles / 64, kMinTriangles, kMaxTriangles);
    const size_t cubes = std::clamp<size_t>(in_all / kInASmallCube, 8, kMaxCubes);
    const size_t in_small = in_all / cubes;
    return {cubes_around(centers, cubes, double(in_small) / rate), in_small,
            cubes_around(centers, kLargeCubes, double(kInALargeCube) / rate)};
}

CubeGrid::CubeGrid(std::span<const Box> cubes)
    : cubes_(cubes), cells_(size_t(kSide) * kSide * kSide, 0) {
    assert(cubes.size() <= kMaxCubes);
    for (const Box& cube : cubes)
        bounds_.add(cube);
    scale_ = dvec3(kSide) / glm::max(bounds_.extent(), dvec3(1e-300));
    for (size_t c = 0; c < cubes.size(); ++c)
        each_cell(cubes[c], [&](size_t cell) { cells_[cell] |= uint64_t(1) << c; });
}

/// Returns a bit for each cube that the box may touch.
uint64_t CubeGrid::near_to(const Box& box) const {
    if (!bounds_.touches(box))
        return 0;
    uint64_t found = 0;
    each_cell(box, [&](size_t cell) { found |= cells_[cell]; });
    return found;
}

uint64_t CubeGrid::touched(const Triangle& triangle) const {
    const Box box = bounds_of(triangle);
    uint64_t found = near_to(box);
    for (uint64_t near = found; near; near &= near - 1) {
        const int cube = std::countr_zero(near);
        if (!cubes_[size_t(cube)].touches(box) ||
            clipped_bounds(triangle, cubes_[size_t(cube)]).empty())
            found &= ~(uint64_t(1) << cube);
    }
    return found;
}

int CubeGrid::cell_of(double x, int axis) const {
    return int(std::clamp((x - bounds_.lo[axis]) * scale_[axis], 0.0, double(kSide - 1)));
}

template <class Visit>
void CubeGrid::each_cell(const Box& box, Visit&& visit) const {
    std::array<int, 3> lo, hi;
    for (int axis = 0; axis < 3; ++axis) {
        lo[axis] = cell_of(box.lo[axis], axis);
        hi[axis] = cell_of(box.hi[axis], axis);
    }
    for (int z = lo[2]; z <= hi[2]; ++z)
        for (int y = lo[1]; y <= hi[1]; ++y)
            for (int x = lo[0]; x <= hi[0]; ++x)
                visit(size_t((z * kSide + y) * kSide + x));
}

} // namespace ovc
