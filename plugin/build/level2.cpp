// SPDX-License-Identifier: Apache-2.0
// Builds level 1, then all pages in parallel, and cuts leaves again whose page turns out too large.
#include "plugin/build/level2.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "gpu/frame/frames.h"
#include "kdtree/far_search.h"
#include "kdtree/sample.h"
#include "plugin/plan/one_leaf.h"
#include "plugin/plan/page_rate.h"

#include <algorithm>
#include <cassert>
#include <optional>

namespace ovc {

bool LeafLimits::pages_matter() const {
    return triangles > page_bytes / kMaxBytesPerTriangle;
}

/// Returns how many triangles fit into so many bytes on average, less a twentieth, so that most
/// leaves that are worse than the average fit as well.
static uint64_t triangles_in(uint64_t bytes, double bytes_per_triangle) {
    return uint64_t(0.95 * double(bytes - std::min(bytes, kPageStart)) /
                    std::max(bytes_per_triangle, 1.0));
}

bool LeafLimits::fits(uint64_t all, double bytes_per_triangle) const {
    return all <= triangles_in(whole_bytes, bytes_per_triangle);
}

uint32_t LeafLimits::triangles_at(double bytes_per_triangle) const {
    const uint64_t max_triangles = triangles_in(page_bytes, bytes_per_triangle);
    return uint32_t(std::clamp<uint64_t>(std::min(max_triangles, triangles), 1, kNone - 1));
}

uint32_t LeafLimits::triangles_again(uint64_t triangles_before, uint64_t bytes_before) const {
    assert(triangles_before > 1);
    const double rate = double(bytes_before) / double(triangles_before);
    return uint32_t(std::min<uint64_t>(triangles_at(rate), triangles_before - 1));
}

namespace {

class LevelsBuilder {
public:
    LevelsBuilder(BuiltScene& scene, BuildProgress* progress, double share)
        : soup_(scene.soup),
          numbers_(scene.numbers),
          limits_(scene.limits),
          progress_(progress),
          share_(share),
          scene_(scene) {}

    Result<Done> build(std::span<const TriangleId> triangles, const Box& bounds) {
        assert(limits_.triangles > 0 && std::ranges::is_sorted(triangles));
        const Stopwatch watch;
        if (triangles.empty()) {
            scene_.level1 = Level1{.bounds = bounds};
            if (!bounds.empty()) // those of shared meshes
                scene_.level1.padding = padding_of(bounds);
            return Done{};
        }
        begin(progress_, "level 1", 0.35 * share_, 2 * triangles.size());
        triangles_ = triangles.size();
        // One frame suits where small triangles are not lost in the scene.
        const bool one_frame = one_frame_suits(soup_, triangles, bounds);
        const Sample sample = drawn(triangles, one_frame);
        const uint32_t max_triangles = first_max_triangles(triangles, bounds, one_frame, sample);
        std::vector<TriangleId> far;
        if (needs_far_search(triangles.size(), max_triangles, one_frame))
            far = find_far(soup_, triangles);
        scene_.level1 = partition(soup_, triangles, bounds, max_triangles, progress_, sample,
                                  {.allowed = true, .triangles = far});
        if ((one_frame && far.empty()) || scene_.level1.leaves.size() == 1)
            share_frame(scene_.level1);
        else
            share_frames(soup_, scene_.level1);
        scene_.seconds_level1 += watch.seconds();
        scene_.pages.resize(scene_.level1.leaves.size());
        begin(progress_, "level 2", 0.5 * share_, 2 * scene_.level1.reference_count());
        build_missing_pages(loose_pairs());
        agree_on_loose_pairs();
        while (true) {
            const Result<bool> again = cut_too_large();
            if (!again)
                return again.error();
            if (!*again)
                return Done{};
            build_missing_pages(loose_pairs());
        }
    }

    void build_smallest(std::vector<TriangleId> triangles, const Box& bounds,
                        uint32_t leaf_triangles, bool in_one_frame) {
        assert(leaf_triangles > 0);
        scene_.pages.clear();
        if (triangles.empty())
            return;
        const Stopwatch watch;
        const bool one_frame = in_one_frame || one_frame_suits(soup_, triangles, bounds);
        scene_.level1 =
            partition_by_count(soup_, std::move(triangles), bounds, leaf_triangles, progress_);
        if (one_frame)
            share_frame(scene_.level1);
        else
            share_frames(soup_, scene_.level1);
        scene_.seconds_level1 += watch.seconds();
        scene_.pages = std::vector<Page>(scene_.level1.leaves.size());
        build_missing_pages({});
    }

private:
    bool maybe_one_leaf(bool one_frame) const { return limits_.whole_bytes > 0 && one_frame; }

    /// Draws the sample for first_max_triangles(), or none where that needs none. Where pages do
    /// not matter, leaves are cut by the same sample.
    Sample drawn(std::span<const TriangleId> triangles, bool one_frame) {
        if (!maybe_one_leaf(one_frame) && !limits_.pages_matter())
            return {};
        const uint32_t rate = sample_rate(triangles.size(), limits_.triangles);
        sample_ = sample_triangles(soup_, triangles, rate, progress_);
        return {sample_, rate};
    }

    uint32_t first_max_triangles(std::span<const TriangleId> triangles, const Box& bounds,
                                 bool one_frame, const Sample& sample) const {
        std::optional<PageRates> rates;
        const auto rate_of = [&](uint64_t page, double copies) {
            if (sample.triangles.empty())
                return double(kMaxBytesPerTriangle);
            if (!rates)
                rates.emplace(soup_, triangles,
                              choose_cubes(soup_, sample.triangles, sample.rate, triangles.size()),
                              bounds, one_frame, progress_);
            return rates->mean_of(double(page), copies);
        };
        return limits_.max_triangles(triangles.size(), rate_of, [&] {
            return maybe_one_leaf(one_frame) && one_leaf_pays(soup_, sample.triangles, sample.rate,
                                                              bounds, uint32_t(limits_.triangles));
        });
    }

    /// Loose pairs need a shared frame, because in a frame of its own a leaf may have triangles
    /// that reach far beyond it.
    LoosePairs loose_pairs() const {
        return {scene_.level1.shares_frame && loose_pairs_pay_,
                double(scene_.level1.reference_count()) / double(triangles_)};
    }

    void build_missing_pages(const LoosePairs& loose) {
        const Stopwatch watch;
        parallel_for(scene_.pages.size(), 1, [&](size_t first, size_t last) {
            for (size_t i = first; i < last; ++i)
                if (scene_.pages[i].texels.empty())
                    scene_.pages[i] =
                        build_page(soup_, numbers_, scene_.level1.leaves[i], progress_, loose);
        });
        scene_.seconds_level2 += watch.seconds();
    }

    /// A kernel that knows loose pairs takes longer over every pair. Where few pages have them,
    /// those pages are built again without.
    void agree_on_loose_pairs() {
        uint64_t loose = 0;
        for (size_t i = 0; i < scene_.pages.size(); ++i)
            loose +=
                scene_.pages[i].has_loose_pairs() ? scene_.level1.leaves[i].triangles.size() : 0;
        loose_pairs_pay_ = 2 * loose > scene_.level1.reference_count();
        if (loose == 0 || loose_pairs_pay_)
            return;
        for (Page& page : scene_.pages)
            if (page.has_loose_pairs())
                page = {};
        build_missing_pages(loose_pairs());
    }

    /// Cuts the leaves whose pages are too large; the pages of their parts are then missing.
    /// Returns false where there are no such leaves.
    Result<bool> cut_too_large() {
        const Stopwatch watch;
        std::vector<uint32_t> max_triangles(scene_.pages.size(), kNone);
        const uint64_t max_bytes = limits_.page_bytes_of(max_triangles.size());
        bool any = false;
        for (size_t i = 0; i < max_triangles.size(); ++i) {
            const uint64_t bytes = scene_.pages[i].bytes();
            const size_t triangles = scene_.level1.leaves[i].triangles.size();
            if (bytes <= max_bytes)
                continue;
            if (triangles == 1)
                return over_budget(
                    format_text("a page of one triangle does not fit into {} bytes", max_bytes));
            max_triangles[i] = limits_.triangles_again(triangles, bytes);
            any = true;
        }
        if (!any)
            return false;
        std::vector<uint32_t> was;
        scene_.level1 = cut_again(soup_, std::move(scene_.level1), max_triangles, was, progress_);
        assert(was.size() == scene_.level1.leaves.size());
        std::vector<Page> pages(was.size());
        for (size_t i = 0; i < was.size(); ++i)
            if (was[i] != kNone)
                pages[i] = std::move(scene_.pages[was[i]]);
        scene_.pages = std::move(pages);
        scene_.seconds_level1 += watch.seconds();
        return true;
    }

    const Soup& soup_;
    const Numbering& numbers_;
    const LeafLimits& limits_;
    BuildProgress* const progress_;
    const double share_; // of the whole progress
    uint64_t triangles_ = 0;
    std::vector<TriangleId> sample_;
    bool loose_pairs_pay_ = true;
    BuiltScene& scene_;
};

} // namespace

void build_smallest_levels(BuiltScene& scene, Hittable hittable, uint32_t leaf_triangles,
                           bool in_one_frame, BuildProgress* progress) {
    LevelsBuilder(scene, progress, 0)
        .build_smallest(std::move(hittable.triangles), hittable.bounds, leaf_triangles,
                        in_one_frame);
}

Result<Done> build_levels(BuiltScene& scene, const Hittable& hittable, BuildProgress* progress,
                          double share) {
    return LevelsBuilder(scene, progress, share).build(hittable.triangles, hittable.bounds);
}

} // namespace ovc
