// SPDX-License-Identifier: Apache-2.0
// Cells are cut as partition() cuts those that hold more than their sample made believe, and again
// where a page turns out too large.
#include "plugin/out_of_core/cell_builder.h"

#include "core/system/parallel.h"
#include "core/text/format_text.h"
#include "kdtree/cells.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace ovc {
namespace {

class CellBuilder {
public:
    CellBuilder(const LocalSoup& soup, const Leaf& planned, const CellOptions& options,
                BuildProgress* progress)
        : soup_(soup), planned_(planned), options_(options), progress_(progress) {}

    Result<BuiltCell> build(const Box& box) {
        std::vector<TriangleId> triangles = soup_.triangles();
        const Duplicates found = Duplicates::take_out(soup_.soup(), triangles);
        for (const Duplicates::Pair& pair : found.pairs())
            built_.duplicates.push_back({soup_.name(pair.smallest), soup_.name(pair.other)});
        if (const Result<Done> done = add(triangles, box, options_.max_triangles); !done)
            return done.error();
        return std::move(built_);
    }

private:
    /// Appends the tree over `box`, with its leaves and pages.
    Result<Done> add(std::span<const TriangleId> triangles, const Box& box,
                     uint32_t max_triangles) {
        Level1 level =
            cut_cell(soup_.soup(), triangles, options_.bounds, box, max_triangles, options_.cut);
        std::vector<Page> pages(level.leaves.size());
        parallel_for(pages.size(), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i) {
                level.leaves[i].frame = planned_.frame;
                level.leaves[i].grid = planned_.grid;
                pages[i] = page_of(level.leaves[i]);
            }
        });
        const std::vector<Cell> cells = cells_of(level.nodes, box, level.padding);
        std::vector<uint32_t> now_at(level.nodes.size());
        auto cell = cells.begin();
        for (size_t n = 0; n < level.nodes.size(); ++n) {
            now_at[n] = uint32_t(built_.nodes.size());
            if (!level.nodes[n].is_leaf())
                built_.nodes.push_back(level.nodes[n]);
            else if (const Result<Done> done = add_leaves(level, pages, n, (cell++)->box); !done)
                return done;
        }
        for (size_t n = 0; n < level.nodes.size(); ++n)
            if (!level.nodes[n].is_leaf())
                built_.nodes[now_at[n]].set_above(now_at[level.nodes[n].above()]);
        return Done{};
    }

    /// Appends the leaves of a leaf node, or smaller ones where a page is too large.
    Result<Done> add_leaves(Level1& level, std::vector<Page>& pages, size_t n, const Box& box) {
        const KdNode node = level.nodes[n];
        uint32_t limit = kNone;
        std::vector<TriangleId> all;
        for (uint32_t i = node.first(); i < node.first() + node.count(); ++i) {
            const std::vector<TriangleId>& triangles = level.leaves[i].triangles;
            all.insert(all.end(), triangles.begin(), triangles.end());
            const uint64_t bytes = pages[i].bytes();
            if (bytes <= options_.max_page_bytes)
                continue;
            if (triangles.size() == 1)
                return over_budget(format_text("a page of one triangle does not fit into {} bytes",
                                               options_.max_page_bytes));
            const LeafLimits limits{triangles.size(), options_.max_page_bytes};
            limit = std::min(limit, limits.triangles_again(triangles.size(), bytes));
        }
        if (limit != kNone) {
            std::ranges::sort(all);
            return add(all, box, limit);
        }
        built_.nodes.push_back(KdNode::leaf(uint32_t(built_.leaves.size()), node.count()));
        for (uint32_t i = node.first(); i < node.first() + node.count(); ++i) {
            for (TriangleId& id : level.leaves[i].triangles)
                id = soup_.name(id);
            built_.leaves.push_back(std::move(level.leaves[i]));
            built_.pages.push_back(std::move(pages[i]));
        }
        return Done{};
    }

    Page page_of(const Leaf& leaf) const {
        std::vector<uint32_t> numbers;
        numbers.reserve(leaf.triangles.size());
        for (const TriangleId id : leaf.triangles) {
            const TriangleId name = soup_.name(id);
            numbers.push_back(options_.first_numbers[name.mesh] + name.prim);
        }
        return build_page(soup_.soup(), numbers, leaf, progress_, options_.loose);
    }

    const LocalSoup& soup_;
    const Leaf& planned_;
    const CellOptions& options_;
    BuildProgress* const progress_;
    BuiltCell built_;
};

} // namespace

Result<BuiltCell> build_cell(const LocalSoup& soup, const Box& box, const Leaf& planned,
                             const CellOptions& options, BuildProgress* progress) {
    return CellBuilder(soup, planned, options, progress).build(box);
}

} // namespace ovc
