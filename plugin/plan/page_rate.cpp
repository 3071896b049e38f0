// SPDX-License-Identifier: Apache-2.0
// PageRates: chooses cubes, finds the triangles that touch them by a coarse grid, and builds their
// pages.
#include "plugin/plan/page_rate.h"

#include "core/system/parallel.h"
#include "gpu/frame/frames.h"
#include "gpu/page/page.h"
#include "kdtree/clip.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

constexpr size_t kMaxCubes = 64; // a word has a bit for each
constexpr uint64_t kMinTriangles = 4096;
constexpr uint64_t kMaxTriangles = 32768;
constexpr size_t kMaxOverfull = 8; // times the triangles that a cube was made for
constexpr size_t kInASmallCube = 512;
// In cubes of this size planes cut triangles as often as in pages.
constexpr size_t kLargeCubes = 4;
constexpr size_t kInALargeCube = 8192;
/// The share of the cuts that a page is allowed which planes make, where few are allowed. Measured
/// among slivers in 16 to 130 leaves: 0.8 to 1.1, the last because of pairs that stay alone.
constexpr double kCutOfAllowed = 0.9;

/// Returns the cube around `center`, one of the centres, that holds `count` of them.
Box cube_around(const dvec3& center, std::span<const dvec3> centers, size_t count,
                std::vector<double>& distances) {
    distances.resize(centers.size());
    std::transform(centers.begin(), centers.end(), distances.begin(),
                   [&](const dvec3& other) { return max_component(glm::abs(other - center)); });
    const auto nth =
        distances.begin() + ptrdiff_t(std::min(std::max<size_t>(count, 1), centers.size()) - 1);
    std::nth_element(distances.begin(), nth, distances.end());
    return {center - dvec3(*nth), center + dvec3(*nth)};
}

std::vector<Box> choose_cubes(const Soup& soup, std::span<const TriangleId> sample, uint32_t rate,
                              size_t cubes, size_t triangles_each) {
    assert(!sample.empty() && rate > 0);
    std::vector<dvec3> centers(sample.size());
    parallel_for(sample.size(), 4096, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i) {
            const Triangle t = soup.triangle(sample[i]);
            centers[i] = (t[0] + t[1] + t[2]) / 3.0;
        }
    });
    std::vector<Box> chosen(cubes);
    parallel_for(cubes, 1, [&](size_t first, size_t last) {
        std::vector<double> distances;
        for (size_t c = first; c < last; ++c) {
            // Ids are evenly spread over a scene's parts, so each part gets its share of cubes.
            const size_t i = (2 * c + 1) * sample.size() / (2 * cubes);
            chosen[c] = cube_around(centers[i], centers, triangles_each / rate, distances);
        }
    });
    return chosen;
}

/// A grid around all cubes, with a bit in each cell for every cube that reaches into it.
class CubeGrid {
public:
    explicit CubeGrid(std::span<const Box> cubes) : cells_(kSide * kSide * kSide, 0) {
        assert(cubes.size() <= kMaxCubes);
        for (const Box& cube : cubes)
            bounds_.add(cube);
        scale_ = dvec3(kSide) / glm::max(bounds_.extent(), dvec3(1e-300));
        for (size_t c = 0; c < cubes.size(); ++c)
            each_cell(cubes[c], [&](uint64_t& cell) { cell |= uint64_t(1) << c; });
    }

    /// Returns a bit for each cube that the box may touch.
    uint64_t near(const Box& box) {
        if (!bounds_.touches(box))
            return 0;
        uint64_t found = 0;
        each_cell(box, [&](uint64_t& cell) { found |= cell; });
        return found;
    }

private:
    static constexpr int kSide = 32;

    int cell_of(double x, int axis) const {
        return int(std::clamp((x - bounds_.lo[axis]) * scale_[axis], 0.0, double(kSide - 1)));
    }

    template <class Visit>
    void each_cell(const Box& box, Visit&& visit) {
        std::array<int, 3> lo, hi;
        for (int axis = 0; axis < 3; ++axis) {
            lo[axis] = cell_of(box.lo[axis], axis);
            hi[axis] = cell_of(box.hi[axis], axis);
        }
        for (int z = lo[2]; z <= hi[2]; ++z)
            for (int y = lo[1]; y <= hi[1]; ++y)
                for (int x = lo[0]; x <= hi[0]; ++x)
                    visit(cells_[size_t((z * kSide + y) * kSide + x)]);
    }

    Box bounds_;
    dvec3 scale_;
    std::vector<uint64_t> cells_;
};

/// Returns `members`, where members[c] has the triangles that touch cube c, in order.
std::vector<std::vector<TriangleId>> members_of(std::span<const Box> cubes, const Soup& soup,
                                                std::span<const TriangleId> triangles,
                                                BuildProgress* progress) {
    CubeGrid grid(cubes);
    constexpr size_t kBlock = 1 << 16; // each with lists of its own, so that the order is kept
    std::vector<std::vector<std::pair<uint32_t, TriangleId>>> parts(triangles.size() / kBlock + 1);
    parallel_for(parts.size(), 1, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        for (size_t b = first; b < last; ++b) {
            const size_t end = std::min(triangles.size(), (b + 1) * kBlock);
            for (size_t i = b * kBlock; i < end; ++i, loop.step()) {
                const Triangle triangle = soup.triangle(triangles[i]);
                const Box box = bounds_of(triangle);
                for (uint64_t near = grid.near(box); near; near &= near - 1) {
                    const uint32_t c = uint32_t(std::countr_zero(near));
                    if (cubes[c].touches(box) && !clipped_bounds(triangle, cubes[c]).empty())
                        parts[b].emplace_back(c, triangles[i]);
                }
            }
        }
        loop.finish();
    });
    std::vector<std::vector<TriangleId>> members(cubes.size());
    for (const auto& part : parts)
        for (const auto& [c, id] : part)
            members[c].push_back(id);
    return members;
}

/// Makes pages of cubes as they would be made of leaves.
class CubePages {
public:
    CubePages(const Soup& soup, std::span<const TriangleId> triangles,
              std::span<const TriangleId> sample, uint32_t rate, const Box& bounds,
              BuildProgress* progress)
        : soup_(soup),
          triangles_(triangles),
          sample_(sample),
          rate_(rate),
          frame_(scene_leaf(bounds).frame),
          loose_{one_frame_suits(soup, triangles, bounds)},
          progress_(progress) {}

    struct CubePage {
        dvec3 center;
        size_t triangles;
        Page page;
    };

    /// Makes so many cubes of about triangles_each triangles. Returns those that triangles touch.
    std::vector<CubePage> make(size_t cubes, size_t triangles_each) const {
        const std::vector<Box> chosen = choose_cubes(soup_, sample_, rate_, cubes, triangles_each);
        std::vector<std::vector<TriangleId>> members =
            members_of(chosen, soup_, triangles_, progress_);
        std::vector<CubePage> made(cubes);
        parallel_for(cubes, 1, [&](size_t first, size_t last) {
            for (size_t c = first; c < last; ++c) {
                // Very many triangles touch a cube where they are far larger than the gaps between
                // them.
                members[c].resize(std::min(members[c].size(), kMaxOverfull * triangles_each));
                if (!members[c].empty())
                    made[c] = {chosen[c].center(), members[c].size(),
                               page_of(members[c], chosen[c])};
                add(progress_, 0);
            }
        });
        std::erase_if(made, [](const CubePage& cube) { return cube.triangles == 0; });
        return made;
    }

private:
    Page page_of(std::span<const TriangleId> triangles, const Box& cube) const {
        Leaf leaf = whole_leaf(soup_, triangles, cube);
        if (loose_.allowed)
            leaf.frame = frame_;
        return build_page(soup_, leaf, nullptr, loose_);
    }

    const Soup& soup_;
    const std::span<const TriangleId> triangles_, sample_;
    const uint32_t rate_;
    const Frame frame_;
    const LoosePairs loose_;
    BuildProgress* const progress_;
};

/// Returns by how many units a triangle of the page is in more than one, on average.
double cut_share(const CubePages::CubePage& cube) {
    assert(cube.triangles > 0);
    size_t count = 0;
    for (uint64_t unit = OVC_ROOT_UNIT; unit < cube.page.units(); ++unit) {
        const uvec4* const texel = &cube.page.view()[unit * OVC_UNIT_TEXELS];
        if (texel[3].w & OVC_PAIR)
            count += texel[1].w == OVC_NO_TRIANGLE ? 1 : 2;
    }
    return double(count) / double(cube.triangles) - 1;
}

double mean_cut_share(std::span<const CubePages::CubePage> cubes) {
    double sum = 0;
    for (const auto& cube : cubes)
        sum += cut_share(cube);
    return cubes.empty() ? 0 : sum / double(cubes.size());
}

} // namespace

PageRates::PageRates(const Soup& soup, std::span<const TriangleId> triangles,
                     std::span<const TriangleId> sample, uint32_t rate, const Box& bounds,
                     BuildProgress* progress) {
    const CubePages pages(soup, triangles, sample, rate, bounds, progress);
    const uint64_t in_all =
        std::clamp<uint64_t>(triangles.size() / 64, kMinTriangles, kMaxTriangles);
    const size_t cubes = std::clamp<size_t>(in_all / kInASmallCube, 8, kMaxCubes);
    const auto small = pages.make(cubes, in_all / cubes);
    for (const auto& cube : small)
        clusters_.push_back(
            {cube.center, double(cube.page.bytes() - kPageStart) / double(cube.triangles)});
    if (std::ranges::any_of(small, [](const auto& cube) { return cube.page.has_loose_pairs(); })) {
        cut_in_small_ = mean_cut_share(small);
        cut_in_large_ = mean_cut_share(pages.make(kLargeCubes, kInALargeCube));
    }
    for (const Cluster& cluster : clusters_)
        mean_ += cluster.rate / double(clusters_.size());
    double squares = 0;
    for (const Cluster& cluster : clusters_)
        squares += (cluster.rate - mean_) * (cluster.rate - mean_);
    spread_ = clusters_.size() > 1 ? std::sqrt(squares / double(clusters_.size() - 1)) : 0;
}

size_t PageRates::cubes_in(const Box& box, double& sum) const {
    size_t count = 0;
    for (const Cluster& cluster : clusters_)
        if (box.contains(cluster.center)) {
            sum += cluster.rate;
            ++count;
        }
    return count;
}

double PageRates::within(const Box& box) const {
    // One cube alone says little of a whole leaf, so the average counts as another one.
    double sum = mean_;
    const size_t cubes = cubes_in(box, sum);
    return sum / double(cubes + 1);
}

double PageRates::worst_within(const Box& box) const {
    double sum = mean_;
    const size_t cubes = cubes_in(box, sum);
    return cubes ? sum / double(cubes + 1) : mean_ + spread_;
}

double PageRates::with_cuts(double triangles, double copies) const {
    // The cuts grow level by level from those in small cubes to those in large ones.
    const double levels = std::log2(triangles / kInASmallCube);
    const double way = std::clamp(levels / std::log2(kInALargeCube / kInASmallCube), 0.0, 1.0);
    const double cut = cut_in_small_ + way * (cut_in_large_ - cut_in_small_);
    const double most = kCutOfAllowed * LoosePairs{true, copies}.max_cut();
    return (1 + std::min(cut, most)) / (1 + cut_in_small_);
}

} // namespace ovc
