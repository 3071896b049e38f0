// SPDX-License-Identifier: Apache-2.0
// plan_streamed() surveys the source and cuts level 1 as a build does. Then it goes through the
// source once more, counts triangles in cells, and keeps those of some cubes, whose pages tell what
// all pages take.
#include "plugin/out_of_core/streamed_plan.h"

#include "core/duplicates.h"
#include "core/system/parallel.h"
#include "gpu/frame/frames.h"
#include "kdtree/cells.h"
#include "kdtree/partition.h"
#include "plugin/out_of_core/local_soup.h"
#include "plugin/out_of_core/source_blocks.h"
#include "plugin/out_of_core/source_survey.h"
#include "plugin/out_of_core/streamed_cut.h"
#include "plugin/plan/cubes.h"
#include "plugin/plan/forecast.h"
#include "plugin/plan/level_sizes.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <vector>

namespace ovc {
namespace {

/// Very many triangles touch a cube where they are far larger than the gaps between them. So many
/// times the triangles that a small one was made for are enough to tell what they take.
constexpr size_t kOverfull = 2;

/// The result of the second look at the source.
struct Counted {
    explicit Counted(size_t cells, std::span<const SourceMesh> meshes)
        : near(cells), far(cells), in_cubes(meshes) {}

    std::vector<std::atomic<uint64_t>> near; // triangles that touch each cell
    std::vector<std::atomic<uint64_t>> far;  // of those that touch kFarCells or more
    std::atomic<uint64_t> all_far{0};        // these, each counted once
    LocalSoup in_cubes;                      // those that touch a cube
};

class SourceCounter {
public:
    SourceCounter(const CellFinder& finder, const Cubes& cubes, Counted& counted)
        : finder_(finder),
          small_(cubes.small),
          large_(cubes.large),
          made_for_(cubes.in_small),
          counted_(counted) {}

    void count(TriangleSource& source, BuildProgress* progress) {
        for_each_blocks(source, [&](std::span<const SourceBlock> blocks) {
            std::vector<std::vector<InCubes>> kept(blocks.size());
            parallel_for(blocks.size(), 1, [&](size_t first, size_t last) {
                for (size_t b = first; b < last; ++b) {
                    kept[b] = count(blocks[b], source.meshes()[blocks[b].mesh]);
                    add(progress, blocks[b].count);
                }
            });
            for (size_t b = 0; b < blocks.size(); ++b)
                for (const InCubes& found : kept[b])
                    if (takes(found))
                        counted_.in_cubes.add(blocks[b].id(found.triangle),
                                              blocks[b].corners_of(found.triangle));
        });
        counted_.in_cubes.finish();
    }

private:
    /// A triangle, by its place in its block, and a bit for each cube that it touches.
    struct InCubes {
        uint32_t triangle;
        uint64_t small, large;
    };

    /// Returns whether a cube has room for the triangle, and counts it.
    bool takes(const InCubes& found) {
        bool is_taken = false;
        const auto enter = [&](uint64_t touched, auto& counts, size_t max) {
            for (; touched; touched &= touched - 1)
                is_taken |= counts[size_t(std::countr_zero(touched))]++ < max;
        };
        enter(found.small, in_small_, kOverfull * made_for_);
        enter(found.large, in_large_, kInALargeCube);
        return is_taken;
    }

    /// Returns those of the block that touch a cube.
    std::vector<InCubes> count(const SourceBlock& block, const SourceMesh& mesh) {
        std::vector<InCubes> kept;
        std::vector<uint32_t> touched;
        const Chunk chunk = borrowed_chunk(mesh, block.corners);
        for (uint32_t i = 0; i < block.count; ++i) {
            const Triangle triangle = chunk.triangle(i);
            if (triangle_fault(triangle) != TriangleFault::None)
                continue;
            touched.clear();
            finder_.find(triangle, [&](uint32_t c) { touched.push_back(c); });
            const bool is_far = finder_.cells() > 1 && touched.size() >= kFarCells;
            counted_.all_far += is_far;
            for (const uint32_t c : touched)
                ++(is_far ? counted_.far : counted_.near)[c];
            const InCubes found{i, small_.touched(triangle), large_.touched(triangle)};
            if (found.small | found.large)
                kept.push_back(found);
        }
        return kept;
    }

    const CellFinder& finder_;
    const CubeGrid small_, large_;
    const size_t made_for_;
    std::array<size_t, 64> in_small_{}, in_large_{};
    Counted& counted_;
};

/// Returns the triangles of each cell, and behind them those that lie apart because they reach far.
std::vector<uint64_t> counts_of(const Counted& counted, uint64_t triangles,
                                uint32_t max_triangles) {
    const bool apart = far_leaf_pays(counted.all_far, triangles, max_triangles);
    std::vector<uint64_t> counts;
    for (size_t c = 0; c < counted.near.size(); ++c)
        counts.push_back(counted.near[c] + (apart ? 0 : counted.far[c].load()));
    counts.push_back(apart ? counted.all_far.load() : 0);
    return counts;
}

class StreamedPlanner {
public:
    StreamedPlanner(TriangleSource& source, uint64_t host_bytes, const TwoLevelOptions& options,
                    const MemoryPlan& memory, BuildProgress* progress)
        : source_(source),
          host_bytes_(host_bytes),
          budget_(host_budget(host_bytes, source.meshes())),
          options_(options),
          memory_(memory),
          progress_(progress),
          all_(triangles_of(source.meshes())) {}

    Result<ovc_plan> run(const DeviceInfo& device) {
        if (budget_.bytes < smallest_host_budget(all_, budget_.threads))
            return too_small(host_bytes_, source_.meshes());
        begin(progress_, "planning", 1, 2 * all_);
        const uint32_t rate = streamed_sample_rate(
            budget_, all_, streamed_limits(options_, memory_, budget_, all_).max_triangles);
        const SourceSurvey surveyed = survey_source(source_, rate, progress_);
        ovc_plan plan{.struct_size = sizeof(ovc_plan)};
        plan.triangles = all_;
        plan.hittable = surveyed.hittable();
        plan.gpu_budget_bytes = memory_.budget_bytes;
        plan.ray_bytes = memory_.ray_bytes();
        plan.batch_rays = memory_.batch_rays;
        AllSizes sizes{.corner_blocks = surveyed.sums.sums.size()};
        if (plan.hittable > 0)
            estimate(surveyed, rate, sizes);
        const uint64_t needed = (1 + sizes.portals) * kPortalBytes + max_top_level_bytes(1) +
                                sizes.cuts.pages.size() * kMaxBytesPerPart +
                                sizes.cuts.largest_page;
        plan.fits = memory_.pool_bytes >= needed;
        plan.smallest_budget_bytes = smallest_budget(needed, device); // about
        if (plan.fits)
            plan.smallest_budget_bytes = std::min(plan.smallest_budget_bytes, memory_.budget_bytes);
        if (!sizes.cuts.pages.empty())
            fill_in(plan, sizes, memory_);
        return plan;
    }

private:
    void estimate(const SourceSurvey& surveyed, uint32_t rate, AllSizes& sizes) {
        const uint64_t hittable = surveyed.hittable();
        const Box& bounds = surveyed.found.bounds;
        const StreamedLimits limits = streamed_limits(options_, memory_, budget_, hittable);
        const Soup& sample = surveyed.sample.soup();
        std::vector<TriangleId> drawn = surveyed.sample.triangles();
        Duplicates::take_out(sample, drawn);
        const uint64_t duplicates =
            std::min(rate * (surveyed.sample.size() - drawn.size()), hittable - 1); // about
        const double padding = padding_of(bounds);
        const std::vector<KdNode> planes =
            streamed_planes(sample, drawn, rate, hittable, bounds, limits.max_triangles, progress_);
        const std::vector<Cell> cells = cells_of(planes, bounds, padding);
        const CellFinder finder(planes, cells, padding);
        // Where all triangles are duplicates of a few, perhaps none was drawn.
        Cubes cubes = drawn.empty() ? Cubes() : choose_cubes(sample, drawn, rate, hittable);
        if (!cubes.large.empty()) // their pages are built at once
            cubes.large.resize(std::clamp<size_t>(budget_.triangles_at_once() / kInALargeCube, 1,
                                                  cubes.large.size()));
        Counted counted(cells.size(), source_.meshes());
        SourceCounter(finder, cubes, counted).count(source_, progress_);
        std::vector<uint64_t> counts = counts_of(counted, hittable, limits.max_triangles);
        // Duplicates are dealt to cells, but only one of them is in a leaf.
        if (!drawn.empty())
            for (uint64_t& count : counts)
                count = uint64_t(std::llround(double(count) * double(drawn.size()) /
                                              double(surveyed.sample.size())));
        const bool one_frame = cells.size() == 1 || one_frame_suits(sample, drawn, bounds);
        std::vector<TriangleId> in_cubes = counted.in_cubes.triangles();
        Duplicates::take_out(counted.in_cubes.soup(), in_cubes);
        const PageRates rates(counted.in_cubes.soup(), in_cubes, cubes, bounds, one_frame);
        sizes.cuts = estimated_sizes({cells, counts, planes.size(), hittable - duplicates,
                                      limits.max_triangles, bounds.padded(padding), one_frame},
                                     rates, limits.limits);
        sizes.portals = sizes.cuts.parts;
        sizes.duplicates = duplicates;
    }

    TriangleSource& source_;
    const uint64_t host_bytes_;
    const HostBudget budget_; // of host_bytes_
    const TwoLevelOptions& options_;
    const MemoryPlan& memory_;
    BuildProgress* const progress_;
    const uint64_t all_; // triangles, whether they can be hit or not
};

/// Returns the most that tracing takes of so many bytes: tables, pages and corners.
uint64_t host_bytes_of(const ovc_plan& plan, std::span<const SourceMesh> meshes, uint64_t budget) {
    uint64_t bytes = plan.saved_bytes - plan.leaf_references * sizeof(TriangleId);
    for (const SourceMesh& mesh : meshes)
        bytes += mesh.triangles * mesh.triangle_bytes();
    return std::min(bytes, budget);
}

} // namespace

Result<ovc_plan> plan_streamed(TriangleSource& source, uint64_t host_bytes,
                               const TwoLevelOptions& options, const DeviceInfo& device,
                               BuildProgress* progress) {
    const uint64_t triangles = triangles_of(source.meshes());
    const Result<MemoryPlan> memory = plan_memory(triangles, options, device);
    if (!memory)
        return memory.error();
    Result<ovc_plan> plan =
        host_budget(host_bytes, source.meshes()).holds(triangles)
            ? forecast(read_soup(source), options, device, progress)
            : StreamedPlanner(source, host_bytes, options, *memory, progress).run(device);
    if (!plan)
        return plan;
    plan->smallest_host_bytes = smallest_host_bytes(source.meshes());
    plan->host_bytes = host_bytes_of(*plan, source.meshes(), host_bytes);
    return plan;
}

} // namespace ovc
