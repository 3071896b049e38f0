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
#include "plugin/build/saved_levels.h"
#include "plugin/plan/one_leaf.h"
#include "plugin/plan/page_rate.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

namespace ovc {
namespace {

/// Building so few triangles takes less time than a sample needs to tell anything.
constexpr size_t kBuiltAtOnce = 8192;
/// How full leaves are on average where there are many: measured 0.57 to 0.62 on meshes, up to 0.7
/// on soups.
constexpr double kFill = 0.58;

/// The sizes of a level 1 and its pages.
struct Sizes {
    std::vector<uint64_t> pages; // bytes, in the order of leaves
    uint64_t references = 0;
    uint64_t nodes = 0;
    uint64_t parts = 0; // in frames of their own
    uint64_t largest_page = 0;

    uint64_t level2_bytes() const {
        return std::accumulate(pages.begin(), pages.end(), uint64_t(0));
    }
    void add(const Sizes& more) {
        pages.insert(pages.end(), more.pages.begin(), more.pages.end());
        references += more.references;
        nodes += more.nodes;
        parts += more.parts;
        largest_page = std::max(largest_page, more.largest_page);
    }
};

Sizes sizes_of(const BuiltScene& scene) {
    Sizes sizes;
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
    Sizes estimate(const LeafLimits& limits) {
        draw(sample_rate(triangles_.size(), limits.triangles));
        rates_.emplace(soup_, triangles_, sample_, rate_, bounds_, progress_);
        const bool one_frame = one_frame_suits(soup_, triangles_, bounds_);
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
        sizes_.nodes = tree.nodes.size();
        const uint64_t references = std::accumulate(counts.begin(), counts.end(), uint64_t(0));
        copies_ = std::max(double(references) / double(triangles_.size()), 1.0);
        const uint64_t page_bytes = limits.page_bytes_of(cells.size() + (counts.back() > 0));
        if (counts.back() > 0)
            add_cell(bounds_.padded(padding), counts.back(), page_bytes, limits);
        for (size_t c = 0; c < cells.size(); ++c)
            add_cell(cells[c].padded, counts[c], page_bytes, limits);
        // Where one frame does not suit all, hardly any two of few large leaves share theirs.
        sizes_.parts = one_frame || sizes_.pages.size() == 1 ? 1 : sizes_.pages.size();
        return std::move(sizes_);
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

    void add_cell(const Box& cell, uint64_t count, uint64_t page_bytes, const LeafLimits& limits) {
        // Cells that hold more than the sample told are cut again, and so are too large pages.
        uint64_t parts = (count + leaf_triangles_ - 1) / leaf_triangles_;
        const auto page_at = [&](double rate) {
            const double triangles = double(count) / double(parts);
            return kPageStart + uint64_t(rate * rates_->with_cuts(triangles, copies_) * triangles);
        };
        const auto page = [&] { return page_at(rates_->within(cell)); };
        if (parts > 0 && page() > page_bytes) {
            const double again = kFill * limits.triangles_again(count / parts, page());
            parts = std::max<uint64_t>(2 * parts, uint64_t(std::ceil(double(count) / again)));
        }
        sizes_.nodes += parts > 1 ? 2 * (parts - 1) : 0;
        sizes_.references += count;
        if (parts == 0)
            return;
        sizes_.pages.insert(sizes_.pages.end(), parts, page());
        const uint64_t worst = page_at(rates_->worst_within(cell));
        sizes_.largest_page = std::max(sizes_.largest_page, std::min(worst, page_bytes));
    }

    const Soup& soup_;
    const std::span<const TriangleId> triangles_;
    const Box bounds_;
    BuildProgress* const progress_;
    uint32_t rate_ = 1;
    std::vector<TriangleId> sample_;
    std::optional<PageRates> rates_;
    uint32_t leaf_triangles_ = 1;
    double copies_ = 1; // of a triangle in all leaves
    Sizes sizes_;
};

/// Returns the sizes of one cut. A small one is built, so its sizes are exact.
Result<Sizes> sizes_of(BuiltScene& scene, const Hittable& hittable, BuildProgress* progress) {
    if (hittable.triangles.empty())
        return Sizes();
    if (hittable.triangles.size() > kBuiltAtOnce)
        return Estimator(scene.soup, hittable.triangles, hittable.bounds, progress)
            .estimate(scene.limits);
    if (const Result<Done> built = build_levels(scene, hittable); !built)
        return built.error();
    add(progress, 4 * hittable.triangles.size());
    return sizes_of(scene);
}

/// The sizes of all cuts of a scene, and the numbers that memory depends on besides.
struct AllSizes {
    Sizes cuts;
    uint64_t portals = 0;
    uint64_t duplicates = 0;
    uint64_t cut_count = 1;
};

/// Fills in what follows from the sizes, which are of at least one page. host_bytes is left.
void fill_in(ovc_plan& plan, const AllSizes& all, const Soup& soup, const MemoryPlan& memory) {
    const Sizes& sizes = all.cuts;
    plan.leaves = sizes.pages.size();
    plan.leaf_references = sizes.references;
    plan.level2_bytes = sizes.level2_bytes();
    plan.largest_page_bytes = sizes.largest_page;
    plan.level1_bytes = all.portals > 1 ? (1 + all.portals) * kPortalBytes : 0;
    plan.fits = plan.fits && plan.level1_bytes <= memory.buffer_bytes;
    plan.saved_bytes = saved_bytes({plan.level2_bytes, sizes.references, plan.leaves, sizes.nodes,
                                    all.duplicates, unsummed(soup).sums.size(), all.cut_count});
    const uint64_t room = memory.pool_bytes - std::min(memory.pool_bytes, plan.level1_bytes);
    uint64_t tree = expected_top_level_bytes(max_links(plan.leaves, plan.level2_bytes, room),
                                             plan.level2_bytes);
    if (all.portals > 1) // inner nodes above the portals add a third
        tree += all.portals * OVC_UNIT_BYTES * 4 / 3 + 2 * sizes.parts * OVC_UNIT_BYTES;
    const Fit fit = fit_in(sizes.pages, {room, memory.buffer_bytes}, tree);
    plan.resident_pages = fit.pages;
    if (plan.fits)
        plan.pool_bytes = fit.pages == sizes.pages.size() ? fit.pool_bytes : room;
    plan.host_bytes = plan.level2_bytes + plan.leaf_references * sizeof(TriangleId) +
                      plan.leaves * sizeof(Leaf) + sizes.nodes * sizeof(KdNode) + tree +
                      (all.portals > 1 ? (1 + all.portals) * sizeof(Portal) : 0);
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
        Sizes more = sizes_of(mesh.scene);
        more.pages.clear(); // they are among those of the scene
        all.portals += more.parts * mesh.places.size();
        all.cuts.add(more);
    }
    const uint64_t leaves = all.cuts.pages.size();
    const uint64_t needed = (1 + all.portals) * kPortalBytes + max_top_level_bytes(1) +
                            leaves * kMaxBytesPerPart + all.cuts.largest_page;
    plan.fits = add_tree(*scene, options, memory);
    plan.smallest_budget_bytes = smallest_budget(needed, device); // about
    if (plan.fits)
        plan.smallest_budget_bytes = std::min(plan.smallest_budget_bytes, memory.budget_bytes);
    if (leaves > 0)
        fill_in(plan, all, soup, memory);
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
    AllSizes all;
    Result<Sizes> first = sizes_of(scene, hittable.once, progress);
    if (!first)
        return first.error();
    all.cuts = std::move(*first);
    all.portals = all.cuts.parts;
    all.duplicates = scene.duplicates.count();
    all.cut_count = 1 + scene.shared.size();
    for (size_t i = 0; i < scene.shared.size(); ++i) {
        const SharedMesh& mesh = scene.shared[i];
        const Result<Sizes> more = sizes_of(scene.shared[i].scene, hittable.shared[i], progress);
        if (!more)
            return more.error();
        all.cuts.add(*more);
        all.portals += more->parts * mesh.places.size();
        all.duplicates += mesh.scene.duplicates.count();
    }
    if (!all.cuts.pages.empty())
        fill_in(plan, all, soup, *memory);
    return plan;
}

} // namespace ovc
