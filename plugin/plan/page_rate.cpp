// SPDX-License-Identifier: Apache-2.0
// PageRates: finds the triangles that touch cubes, and builds their pages.
#include "plugin/plan/page_rate.h"

#include "core/system/parallel.h"
#include "gpu/frame/frames.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>

namespace ovc {
namespace {

constexpr size_t kMaxOverfull = 8; // times the triangles that a cube was made for
/// The share of the cuts that a page is allowed which planes make, where few are allowed. Measured
/// among slivers in 16 to 130 leaves: 0.8 to 1.1, the last because of pairs that stay alone.
constexpr double kCutOfAllowed = 0.9;

/// Returns `members`, where members[c] has the triangles that touch cube c, in order.
std::vector<std::vector<TriangleId>> members_of(std::span<const Box> cubes, const Soup& soup,
                                                std::span<const TriangleId> triangles,
                                                BuildProgress* progress) {
    const CubeGrid grid(cubes);
    constexpr size_t kBlock = 1 << 16; // each with lists of its own, so that the order is kept
    std::vector<std::vector<std::pair<uint32_t, TriangleId>>> parts(triangles.size() / kBlock + 1);
    parallel_for(parts.size(), 1, [&](size_t first, size_t last) {
        LoopProgress loop(progress);
        for (size_t b = first; b < last; ++b) {
            const size_t end = std::min(triangles.size(), (b + 1) * kBlock);
            for (size_t i = b * kBlock; i < end; ++i, loop.step()) {
                uint64_t touched = grid.touched(soup.triangle(triangles[i]));
                for (; touched; touched &= touched - 1)
                    parts[b].emplace_back(std::countr_zero(touched), triangles[i]);
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
    CubePages(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
              bool one_frame, BuildProgress* progress)
        : soup_(soup),
          triangles_(triangles),
          frame_(scene_leaf(bounds).frame),
          loose_{one_frame},
          progress_(progress) {}

    struct CubePage {
        dvec3 center;
        size_t triangles;
        Page page;
    };

    /// Returns the pages of those cubes that triangles touch. triangles_each: as they were made
    /// for.
    std::vector<CubePage> make(std::span<const Box> chosen, size_t triangles_each) const {
        std::vector<std::vector<TriangleId>> members =
            members_of(chosen, soup_, triangles_, progress_);
        std::vector<CubePage> made(chosen.size());
        parallel_for(chosen.size(), 1, [&](size_t first, size_t last) {
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
    const std::span<const TriangleId> triangles_;
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

PageRates::PageRates(const Soup& soup, std::span<const TriangleId> triangles, const Cubes& cubes,
                     const Box& bounds, bool one_frame, BuildProgress* progress) {
    const CubePages pages(soup, triangles, bounds, one_frame, progress);
    const auto small = pages.make(cubes.small, cubes.in_small);
    for (const auto& cube : small)
        clusters_.push_back(
            {cube.center, double(cube.page.bytes() - kPageStart) / double(cube.triangles)});
    if (std::ranges::any_of(small, [](const auto& cube) { return cube.page.has_loose_pairs(); })) {
        cut_in_small_ = mean_cut_share(small);
        cut_in_large_ = mean_cut_share(pages.make(cubes.large, kInALargeCube));
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
    const double max_cut = kCutOfAllowed * LoosePairs{true, copies}.max_cut();
    return (1 + std::min(cut, max_cut)) / (1 + cut_in_small_);
}

} // namespace ovc
