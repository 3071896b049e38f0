// SPDX-License-Identifier: Apache-2.0
// save_streamed() surveys the source, deals its triangles to cells, and then goes through the
// cells, which are built some at a time and written in order.
#include "plugin/out_of_core/streamed_build.h"

#include "core/system/parallel.h"
#include "core/text/format_text.h"
#include "gpu/frame/frames.h"
#include "kdtree/cells.h"
#include "plugin/build/build_scene.h"
#include "plugin/build/saved_levels.h"
#include "plugin/out_of_core/build_steps.h"
#include "plugin/out_of_core/cell_builder.h"
#include "plugin/out_of_core/cell_parts.h"
#include "plugin/out_of_core/deal_source.h"
#include "plugin/out_of_core/dealt_cells.h"
#include "plugin/out_of_core/source_survey.h"
#include "plugin/out_of_core/streamed_cut.h"

#include <algorithm>
#include <cassert>
#include <optional>
#include <utility>

namespace ovc {
namespace {

std::vector<uint32_t> first_numbers_of(std::span<const SourceMesh> meshes) {
    std::vector<uint32_t> first;
    uint32_t number = 0;
    for (const SourceMesh& mesh : meshes) {
        first.push_back(number);
        number += uint32_t(mesh.triangles);
    }
    return first;
}

class StreamedBuilder {
public:
    StreamedBuilder(const StreamedScene& scene, const TwoLevelOptions& options,
                    const MemoryPlan& plan, const ByteSink& sink, BuildProgress* progress)
        : source_(scene.source),
          scratch_(scene.scratch),
          host_bytes_(scene.host_bytes),
          budget_(host_budget(scene.host_bytes, source_.meshes())),
          options_(options),
          plan_(plan),
          progress_(progress),
          all_(triangles_of(source_.meshes())),
          first_numbers_(first_numbers_of(source_.meshes())),
          steps_(scene.steps, scratch_),
          levels_(sink, scratch_, steps_) {}

    Result<StreamedLevels> run() {
        if (budget_.bytes < smallest_host_budget(all_, budget_.threads))
            return too_small(host_bytes_, source_.meshes());
        begin(progress_, "triangles", 0.1, all_);
        set_limits(all_);
        const uint32_t rate = streamed_sample_rate(budget_, all_, max_triangles());
        SourceSurvey surveyed = survey_source(source_, rate, progress_);
        hittable_ = surveyed.hittable();
        set_limits(hittable_);
        check_steps(surveyed.sums.checksum(), rate);
        if (hittable_ > 0) {
            deal(std::move(surveyed.sample), surveyed.far, rate, surveyed.found.bounds);
            if (const Result<Done> built = build_cells(rate > 1); !built)
                return built.error();
        }
        level1_.bounds = surveyed.found.bounds;
        return levels_.finish({surveyed.sums, {}, /* any_limits= */ true}, surveyed.found.dropped,
                              hittable_, std::move(level1_), planes_);
    }

private:
    void set_limits(uint64_t triangles) {
        limits_ = streamed_limits(options_, plan_, budget_, triangles);
    }
    uint32_t max_triangles() const { return limits_.max_triangles; }

    /// Throws a Failure where steps were kept of another scene, or where they would come out
    /// differently now.
    void check_steps(uint64_t soup, uint32_t rate) {
        Checksum sum;
        for (const uint64_t number :
             {version_of_levels(), soup, uint64_t(rate), uint64_t(max_triangles()), budget_.bytes,
              uint64_t(budget_.threads), limits_.limits.triangles, limits_.limits.page_bytes,
              limits_.limits.whole_bytes})
            sum.add_value(number);
        const uint64_t expected = sum.value();
        uint64_t found = 0;
        if (!steps_.take(found))
            steps_.keep(expected);
        else if (found != expected)
            BuildSteps::fail();
    }

    /// Chooses planes by the sample, deals all triangles, and plans a leaf for each piece.
    void deal(LocalSoup sample, const FarSearch& far, uint32_t rate, const Box& bounds) {
        std::vector<TriangleId> drawn = sample.triangles();
        Duplicates::take_out(sample.soup(), drawn);
        one_frame_ = one_frame_suits(sample.soup(), drawn, bounds);
        if (needs_far_search(hittable_, max_triangles(), one_frame_))
            far_ = far.found();
        std::erase_if(drawn, [&](TriangleId id) {
            return std::ranges::binary_search(far_, sample.name(id));
        });
        level1_.bounds = bounds;
        level1_.padding = padding_of(bounds);
        begin(progress_, "level 1", 0.3, all_);
        planes_ = streamed_planes(sample.soup(), drawn, rate, hittable_ - far_.size(), bounds,
                                  max_triangles(), progress_);
        cells_ = cells_of(planes_, bounds, level1_.padding);
        const size_t cells = cells_.size() + 1; // the last one is that of far-reaching triangles
        dealt_.emplace(cells, source_.meshes(), budget_.buffer_bytes(cells), scratch_);
        const CellFinder finder(planes_, cells_, level1_.padding);
        if (std::vector<DealtCell> dealt; steps_.take(dealt)) {
            dealt_->restore(std::move(dealt));
            add(progress_, all_);
        } else {
            deal_source(source_, finder, far_, hittable_, max_triangles(), *dealt_, progress_);
            steps_.keep(dealt_->dealt());
        }
        part_large_cells();
        plan_leaves(sample.soup(), drawn, finder);
    }

    /// Finds the pieces that are built. A cell that holds more than is built at once, because its
    /// triangles overlap or are duplicates of a few, is dealt again, to parts.
    void part_large_cells() {
        size_t parts = 0;
        std::vector<size_t> parts_of;
        for (size_t cell = 0; cell < dealt_->cells(); ++cell) {
            parts_of.push_back(parts_of_cell(dealt_->count(cell), budget_.triangles_at_once()));
            parts += parts_of.back();
        }
        std::vector<DealtCell> kept;
        const bool were_kept = parts > 0 && steps_.take(kept);
        parts_.emplace(parts, source_.meshes(), budget_.buffer_bytes(parts), scratch_);
        if (were_kept)
            parts_->restore(std::move(kept));
        size_t part = 0;
        pieces_of_.assign(dealt_->cells(), {});
        const auto add = [&](size_t cell) {
            LeafRange& range = pieces_of_[cell];
            range.first = uint32_t(pieces_.size());
            if (parts_of[cell] == 0 && dealt_->count(cell) > 0)
                pieces_.push_back({&*dealt_, cell, cell});
            if (parts_of[cell] > 0 && !were_kept)
                deal_to_parts(*dealt_, cell, source_.meshes(), *parts_, part, parts_of[cell]);
            for (size_t i = 0; i < parts_of[cell]; ++i, ++part)
                if (parts_->count(part) > 0)
                    pieces_.push_back({&*parts_, part, cell});
            range.count = uint32_t(pieces_.size()) - range.first;
        };
        add(cells_.size());
        for (size_t cell = 0; cell < cells_.size(); ++cell)
            add(cell);
        if (parts > 0 && !were_kept)
            steps_.keep(parts_->dealt());
    }

    /// Decides on frames, by the boxes of pieces and the sample in their cells. planned_ has a leaf
    /// for each piece.
    void plan_leaves(const Soup& sample, std::span<const TriangleId> drawn,
                     const CellFinder& finder) {
        Level1 planned{.nodes = planes_, .bounds = level1_.bounds, .padding = level1_.padding};
        const Box all = level1_.bounds.padded(level1_.padding);
        for (const Piece& piece : pieces_)
            planned.leaves.push_back(leaf_around(is_far(piece) ? all : cells_[piece.cell].padded,
                                                 level1_.padding, piece.bounds()));
        planned.far_leaves = pieces_of_.back().count;
        for (size_t cell = 0; cell < cells_.size(); ++cell)
            planned.nodes[cells_[cell].node] =
                KdNode::leaf(pieces_of_[cell].first, pieces_of_[cell].count);
        if (planned.leaves.size() == 1 || (far_.empty() && one_frame_)) {
            share_frame(planned);
        } else {
            for (const TriangleId id : drawn)
                finder.find(sample.triangle(id), [&](uint32_t c) {
                    if (const LeafRange& in = pieces_of_[c]; in.count > 0) // parts share a sample
                        planned.leaves[in.first + id.prim % in.count].triangles.push_back(id);
                });
            share_frames(sample, planned);
        }
        level1_.shares_frame = planned.shares_frame;
        planned_ = std::move(planned.leaves);
    }

    /// Builds all pieces, as many at a time as there is room for, and writes them in order.
    Result<Done> build_cells(bool by_all) {
        uint64_t references = 0;
        for (const Piece& piece : pieces_)
            references += piece.count();
        begin(progress_, "level 2", 0.6, 2 * references);
        CellOptions options{.bounds = level1_.bounds,
                            .max_triangles = max_triangles(),
                            .cut = by_all ? CellCut::ByAll : CellCut::InOrder,
                            .max_page_bytes = limits_.limits.page_bytes_of(planned_.size()),
                            .first_numbers = first_numbers_};
        const Result<LoosePairs> loose = choose_loose_pairs(options, references);
        if (!loose)
            return loose.error();
        options.loose = *loose;
        size_t at = 0;
        for (; at < pieces_.size() && levels_.add_kept(pieces_[at].cell, is_far(pieces_[at])); ++at)
            add(progress_, 2 * pieces_[at].count());
        while (at < pieces_.size()) {
            const size_t end = end_of_batch(at);
            std::vector<std::optional<Result<BuiltCell>>> built(end - at);
            parallel_for(built.size(), 1, [&](size_t first, size_t last) {
                for (size_t i = first; i < last; ++i)
                    built[i] = build(at + i, options);
            });
            for (size_t i = 0; i < built.size(); ++i, ++at) {
                if (!*built[i])
                    return built[i]->error();
                levels_.add(pieces_[at].cell, is_far(pieces_[at]), std::move(**built[i]));
                built[i].reset();
            }
        }
        return Done{};
    }

    /// Returns the end of as many pieces from `at` on as there is room for, at least one.
    size_t end_of_batch(size_t at) const {
        uint64_t triangles = pieces_[at].count();
        for (++at; at < pieces_.size(); ++at) {
            triangles += pieces_[at].count();
            if (triangles > budget_.triangles_at_once())
                break;
        }
        return at;
    }

    Result<BuiltCell> build(size_t number, CellOptions options) const {
        const Piece& piece = pieces_[number];
        if (is_far(piece) || piece.in == &*parts_)
            options.cut = CellCut::ByCount;
        return build_cell(piece.in->read(piece.index),
                          is_far(piece) ? level1_.bounds : cells_[piece.cell].box, planned_[number],
                          options, progress_);
    }

    /// Lets triangles that share no side lie in one unit where most pages do better so, as a build
    /// in memory does. A few cells tell for all.
    Result<LoosePairs> choose_loose_pairs(CellOptions options, uint64_t references) {
        const size_t asked = std::min<size_t>(pieces_.size(), 4);
        if (!level1_.shares_frame)
            return LoosePairs{};
        options.loose = {true, double(references) / double(hittable_)};
        if (steps_.take(options.loose.allowed))
            return options.loose;
        uint64_t all = 0, loose = 0;
        for (size_t i = 0; i < asked; ++i) {
            const Result<BuiltCell> built =
                build(pieces_.size() * (2 * i + 1) / (2 * asked), options);
            if (!built)
                return built.error();
            for (size_t leaf = 0; leaf < built->leaves.size(); ++leaf) {
                const uint64_t triangles = built->leaves[leaf].triangles.size();
                all += triangles;
                loose += built->pages[leaf].has_loose_pairs() ? triangles : 0;
            }
        }
        options.loose.allowed = 2 * loose > all;
        steps_.keep(options.loose.allowed);
        return options.loose;
    }

    /// What is built by itself: a cell, or a part of one.
    struct Piece {
        const DealtCells* in;
        size_t index; // there
        size_t cell;

        uint64_t count() const { return in->count(index); }
        const Box& bounds() const { return in->bounds(index); }
    };
    bool is_far(const Piece& piece) const { return piece.cell == cells_.size(); }

    TriangleSource& source_;
    ScratchSpace& scratch_;
    const uint64_t host_bytes_;
    const HostBudget budget_; // of host_bytes_
    const TwoLevelOptions& options_;
    const MemoryPlan& plan_;
    BuildProgress* const progress_;
    const uint64_t all_;          // triangles, whether they can be hit or not
    uint64_t hittable_ = 0;       // of them, duplicates included
    bool one_frame_ = true;       // one frame suits them
    std::vector<TriangleId> far_; // what FarSearch found, where that matters
    const std::vector<uint32_t> first_numbers_;
    StreamedLimits limits_;
    Level1 level1_; // without nodes and leaves
    std::vector<KdNode> planes_;
    std::vector<Cell> cells_;
    std::optional<DealtCells> dealt_;  // the last cell is that of far-reaching triangles
    std::optional<DealtCells> parts_;  // of cells that are not built whole
    std::vector<Piece> pieces_;        // of far-reaching triangles first
    std::vector<LeafRange> pieces_of_; // each cell
    std::vector<Leaf> planned_;        // for each piece
    BuildSteps steps_;
    StreamedLevelsWriter levels_;
};

Result<StreamedLevels> save_in_memory(TriangleSource& source, const TwoLevelOptions& options,
                                      const MemoryPlan& plan, const DeviceInfo& device,
                                      const ByteSink& sink, const LogSink& log,
                                      BuildProgress* progress) {
    const Soup soup = read_soup(source);
    if (const Result<Done> enough = check_budget(soup, options, plan, device); !enough)
        return enough.error();
    const Result<BuiltScene> scene = build_scene(soup, options, plan, log, progress);
    if (!scene)
        return scene.error();
    if (!save_levels(*scene, sink))
        throw Cancelled();
    return StreamedLevels{scene->pages.size(), scene->triangles, false};
}

} // namespace

Result<StreamedLevels> stream_levels(const StreamedScene& scene, const TwoLevelOptions& options,
                                     const MemoryPlan& plan, const ByteSink& sink,
                                     BuildProgress* progress) {
    return StreamedBuilder(scene, options, plan, sink, progress).run();
}

Result<StreamedLevels> save_streamed(const StreamedScene& scene, const TwoLevelOptions& options,
                                     const DeviceInfo& device, const ByteSink& sink,
                                     const LogSink& log, BuildProgress* progress) {
    const uint64_t triangles = triangles_of(scene.source.meshes());
    const Result<MemoryPlan> plan = plan_memory(triangles, options, device);
    if (!plan)
        return plan.error();
    if (host_budget(scene.host_bytes, scene.source.meshes()).holds(triangles))
        return save_in_memory(scene.source, options, *plan, device, sink, log, progress);
    return stream_levels(scene, options, *plan, sink, progress);
}

} // namespace ovc
