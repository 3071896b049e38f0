// SPDX-License-Identifier: Apache-2.0
// forecast(): cuts level 1 by a sample, counts all triangles in its cells, and estimates pages by
// those of clusters.
#include "plugin/plan/forecast.h"

#include "core/system/parallel.h"
#include "gpu/frame/frames.h"
#include "kdtree/cells.h"
#include "kdtree/sample.h"
#include "plugin/build/build_scene.h"
#include "plugin/build/level2.h"
#include "plugin/build/restored_levels.h"
#include "plugin/plan/level_sizes.h"
#include "plugin/plan/one_leaf.h"

#include <algorithm>
#include <cassert>
#include <functional>
#include <optional>
#include <utility>

namespace ovc {
namespace {

/// Building so few triangles takes less time than a sample needs to tell anything.
constexpr size_t kBuiltAtOnce = 8192;

LevelSizes sizes_of(const BuiltScene& scene) {
    LevelSizes sizes;
    for (const Page& page : scene.pages)
        sizes.pages.push_back(page.bytes());
    sizes.largest_page = scene.largest_page_bytes();
    sizes.references = scene.level1.reference_count();
    sizes.nodes = scene.level1.nodes.size();
    sizes.parts = parts_of(scene.level1).size();
    return sizes;
}

/// Returns `counts`: counts[c] triangles touch cell c. Triangles that touch far_cells of them or
/// more count behind all cells instead.
std::vector<uint64_t> counted(const Soup& soup, const CellFinder& finder,
                              std::span<const TriangleId> triangles, uint32_t far_cells,
                              BuildProgress* progress) {
    std::vector<std::vector<uint64_t>> parts(kDealtBlocks,
                                             std::vector<uint64_t>(finder.cells() + 1));
    deal(soup, finder, triangles, far_cells, progress,
         [&](size_t block, uint32_t c, TriangleId) { ++parts[block][c]; });
    std::vector<uint64_t> counts(finder.cells() + 1);
    for (const auto& part : parts)
        std::transform(part.begin(), part.end(), counts.begin(), counts.begin(), std::plus());
    return counts;
}

/// Estimates sizes by a sample of the triangles, which are not empty.
class Estimator {
public:
    Estimator(const Soup& soup, std::span<const TriangleId> triangles, const Box& bounds,
              BuildProgress* progress)
        : soup_(soup), triangles_(triangles), bounds_(bounds), progress_(progress) {
        assert(!triangles.empty());
    }

    /// Returns the sizes of leaves that keep to the limits. Called once.
    LevelSizes estimate(const LeafLimits& limits) {
        draw(sample_rate(triangles_.size(), limits.triangles));
        const bool one_frame = one_frame_suits(soup_, triangles_, bounds_);
        rates_.emplace(soup_, triangles_, choose_cubes(soup_, sample_, rate_, triangles_.size()),
                       bounds_, one_frame, progress_);
        leaf_triangles_ = limits.max_triangles(
            triangles_.size(),
            [&](uint64_t page, double copies) { return rates_->mean_of(double(page), copies); },
            [&] {
                return one_frame &&
                       one_leaf_pays(soup_, sample_, rate_, bounds_, uint32_t(limits.triangles));
            });
        assert(leaf_triangles_ > 0);
        if (const uint32_t rate = sample_rate(triangles_.size(), leaf_triangles_); rate != rate_)
            draw(rate);
        const double padding = padding_of(bounds_);
        const KdTree tree = cut_sample(
            soup_, sample_, rate_, bounds_, padding,
            triangles_.size() <= leaf_triangles_ ? kNone - 1 : leaf_triangles_, progress_);
        const std::vector<Cell> cells = cells_of(tree.nodes, bounds_, padding);
        const CellFinder finder(tree.nodes, cells, padding);
        const auto count = [&](uint32_t far_cells) {
            return counted(soup_, finder, triangles_, far_cells, progress_);
        };
        std::vector<uint64_t> counts = count(kFarCells);
        assert(counts.size() == cells.size() + 1);
        if (counts.back() > 0 && !far_leaf_pays(counts.back(), triangles_.size(), leaf_triangles_))
            counts = count(kNone);
        return estimated_sizes({cells, counts, tree.nodes.size(), triangles_.size(),
                                leaf_triangles_, bounds_.padded(padding), one_frame},
                               *rates_, limits);
    }

private:
    /// Draws the sample. The corners' hashes decide which triangles are in it, which may be none
    /// where there are few; then the rate is lowered.
    void draw(uint32_t rate) {
        do {
            rate_ = rate;
            sample_ = sample_triangles(soup_, triangles_, rate, progress_);
            rate /= 2;
        } while (sample_.empty());
    }

    const Soup& soup_;
    const std::span<const TriangleId> triangles_;
    const Box bounds_;
    BuildProgress* const progress_;
    uint32_t rate_ = 1;
    std::vector<TriangleId> sample_;
    std::optional<PageRates> rates_;
    uint32_t leaf_triangles_ = 1;
};

/// Returns the sizes of one cut. A small one is built, so its sizes are exact.
Result<LevelSizes> sizes_of(BuiltScene& scene, const Hittable& hittable, BuildProgress* progress) {
    if (hittable.triangles.empty())
        return LevelSizes();
    if (hittable.triangles.size() > kBuiltAtOnce)
        return Estimator(scene.soup, hittable.triangles, hittable.bounds, progress)
            .estimate(scene.limits);
    if (const Result<Done> built = build_levels(scene, hittable); !built)
        return built.error();
    add(progress, 4 * hittable.triangles.size());
    return sizes_of(scene);
}

/// Returns a plan that knows no sizes yet.
ovc_plan begun_plan(const BuiltScene& scene, const MemoryPlan& memory) {
    ovc_plan plan{};
    plan.struct_size = sizeof(plan);
    plan.triangles = scene.soup.triangle_count();
    plan.hittable = scene.triangles + scene.duplicate_count();
    for (const SharedMesh& mesh : scene.shared)
        plan.hittable += mesh.scene.triangles * mesh.places.size();
    plan.gpu_budget_bytes = memory.budget_bytes;
    plan.ray_bytes = memory.ray_bytes();
    plan.batch_rays = memory.batch_rays;
    return plan;
}

/// Returns the plan of a scene that was saved, whose sizes are there to be read.
Result<ovc_plan> plan_of_saved(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& memory, const DeviceInfo& device) {
    LeafStore& store = *options.store;
    Result<BuiltScene> scene = look_at_stored_levels(store, soup);
    if (!scene)
        return Error{"what was saved " + scene.error().message, ErrorKind::Unreadable};
    ovc_plan plan = begun_plan(*scene, memory);
    AllSizes all{sizes_of(*scene)};
    all.portals = all.cuts.parts;
    for (const SharedMesh& mesh : scene->shared) {
        LevelSizes more = sizes_of(mesh.scene);
        more.pages.clear(); // they are among those of the scene
        all.portals += more.parts * mesh.places.size();
        all.cuts.add(more);
    }
    plan.fits = add_tree(*scene, options, memory);
    plan.smallest_budget_bytes = smallest_budget(*scene, options, device);
    if (!all.cuts.pages.empty())
        fill_in(plan, all, memory);
    plan.saved_bytes = store.saved_bytes();
    plan.host_bytes = store.max_bytes();
    plan.smallest_host_bytes = store.smallest_bytes();
    return plan;
}

} // namespace

Result<ovc_plan> forecast(const Soup& soup, const TwoLevelOptions& options,
                          const DeviceInfo& device, BuildProgress* progress) {
    const Result<MemoryPlan> memory = plan_memory(soup, options, device);
    if (!memory)
        return memory.error();
    if (options.store)
        return plan_of_saved(soup, options, *memory, device);
    BuiltScene scene(soup);
    Placed placed = placed_chunks(soup);
    const SmallestCut cut = smallest_cut(soup, placed, options);
    begin(progress, "planning", 1, 6 * unique_triangles(soup, placed));
    const HittableParts hittable = take_hittable_parts(scene, std::move(placed), progress);
    set_limits(scene, options, *memory);
    ovc_plan plan = begun_plan(scene, *memory);
    plan.smallest_budget_bytes = smallest_budget(cut.pool_bytes, device);
    plan.fits = memory->pool_bytes >= cut.pool_bytes;
    AllSizes all{.corner_blocks = unsummed(soup).sums.size()};
    Result<LevelSizes> first = sizes_of(scene, hittable.once, progress);
    if (!first)
        return first.error();
    all.cuts = std::move(*first);
    all.portals = all.cuts.parts;
    all.duplicates = scene.duplicates.count();
    all.cut_count = 1 + scene.shared.size();
    for (size_t i = 0; i < scene.shared.size(); ++i) {
        const SharedMesh& mesh = scene.shared[i];
        const Result<LevelSizes> more =
            sizes_of(scene.shared[i].scene, hittable.shared[i], progress);
        if (!more)
            return more.error();
        all.cuts.add(*more);
        all.portals += more->parts * mesh.places.size();
        all.duplicates += mesh.scene.duplicates.count();
    }
    if (!all.cuts.pages.empty())
        fill_in(plan, all, *memory);
    return plan;
}

} // namespace ovc
