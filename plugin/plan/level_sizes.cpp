// SPDX-License-Identifier: Apache-2.0
// LevelSizes: cells that hold too much are cut again, as a build would do.
#include "plugin/plan/level_sizes.h"

#include "gpu/page/top_level.h"
#include "plugin/build/saved_levels.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <numeric>

namespace ovc {
namespace {

/// How full leaves are on average where there are many: measured 0.57 to 0.62 on meshes, up to 0.7
/// on soups.
constexpr double kFill = 0.58;

class SizeEstimate {
public:
    SizeEstimate(const CountedCells& level, const PageRates& rates, const LeafLimits& limits)
        : level_(level), rates_(rates), limits_(limits) {}

    LevelSizes estimate() {
        const std::span<const uint64_t> counts = level_.counts;
        assert(counts.size() == level_.cells.size() + 1);
        sizes_.nodes = level_.nodes;
        const uint64_t references = std::accumulate(counts.begin(), counts.end(), uint64_t(0));
        copies_ = std::max(double(references) / double(level_.triangles), 1.0);
        const uint64_t page_bytes =
            limits_.page_bytes_of(level_.cells.size() + (counts.back() > 0));
        if (counts.back() > 0)
            add_cell(level_.padded, counts.back(), page_bytes);
        for (size_t c = 0; c < level_.cells.size(); ++c)
            add_cell(level_.cells[c].padded, counts[c], page_bytes);
        // Where one frame does not suit all, hardly any two of few large leaves share theirs.
        sizes_.parts = level_.one_frame || sizes_.pages.size() == 1 ? 1 : sizes_.pages.size();
        return std::move(sizes_);
    }

private:
    void add_cell(const Box& cell, uint64_t count, uint64_t page_bytes) {
        // Cells that hold more than the sample told are cut again, and so are too large pages.
        uint64_t parts = (count + level_.leaf_triangles - 1) / level_.leaf_triangles;
        const auto page_at = [&](double rate) {
            const double triangles = double(count) / double(parts);
            return kPageStart + uint64_t(rate * rates_.with_cuts(triangles, copies_) * triangles);
        };
        const auto page = [&] { return page_at(rates_.within(cell)); };
        if (parts > 0 && page() > page_bytes) {
            const double again = kFill * limits_.triangles_again(count / parts, page());
            parts = std::max<uint64_t>(2 * parts, uint64_t(std::ceil(double(count) / again)));
        }
        sizes_.nodes += parts > 1 ? 2 * (parts - 1) : 0;
        sizes_.references += count;
        if (parts == 0)
            return;
        sizes_.pages.insert(sizes_.pages.end(), parts, page());
        const uint64_t worst = page_at(rates_.worst_within(cell));
        sizes_.largest_page = std::max(sizes_.largest_page, std::min(worst, page_bytes));
    }

    const CountedCells& level_;
    const PageRates& rates_;
    const LeafLimits& limits_;
    double copies_ = 1; // of a triangle in all leaves
    LevelSizes sizes_;
};

} // namespace

uint64_t LevelSizes::level2_bytes() const {
    return std::accumulate(pages.begin(), pages.end(), uint64_t(0));
}

void LevelSizes::add(const LevelSizes& more) {
    pages.insert(pages.end(), more.pages.begin(), more.pages.end());
    references += more.references;
    nodes += more.nodes;
    parts += more.parts;
    largest_page = std::max(largest_page, more.largest_page);
}

LevelSizes estimated_sizes(const CountedCells& level, const PageRates& rates,
                           const LeafLimits& limits) {
    return SizeEstimate(level, rates, limits).estimate();
}

void fill_in(ovc_plan& plan, const AllSizes& all, const MemoryPlan& memory) {
    const LevelSizes& sizes = all.cuts;
    plan.leaves = sizes.pages.size();
    plan.leaf_references = sizes.references;
    plan.level2_bytes = sizes.level2_bytes();
    plan.largest_page_bytes = sizes.largest_page;
    plan.level1_bytes = all.portals > 1 ? (1 + all.portals) * kPortalBytes : 0;
    plan.fits = plan.fits && plan.level1_bytes <= memory.buffer_bytes;
    plan.saved_bytes = saved_bytes({plan.level2_bytes, sizes.references, plan.leaves, sizes.nodes,
                                    all.duplicates, all.corner_blocks, all.cut_count});
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

} // namespace ovc
