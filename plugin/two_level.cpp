// SPDX-License-Identifier: Apache-2.0
// Two-level: building, and the loop over passes.
#include "plugin/two_level.h"

#include "core/stopwatch.h"
#include "gpu/level1_table.h"
#include "plugin/level2.h"
#include "plugin/wave.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {
namespace {

constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
constexpr uint64_t kPagesAtOnce =
    3; // a page takes at most this share of the pool, so that some stay resident
constexpr uint64_t kDefaultLeaves = 10; // thesis, section 4

} // namespace

uint64_t budget_of(const TwoLevelOptions& options, const DeviceInfo& device) {
    return options.budget_bytes ? options.budget_bytes : device.default_budget_bytes();
}

LeafLimits limits_of(const TwoLevelOptions& options, const MemoryPlan& plan, uint64_t triangles) {
    const uint64_t parts = options.leaves ? options.leaves : kDefaultLeaves;
    return {options.leaf_triangles ? options.leaf_triangles
                                   : std::max<uint64_t>((triangles + parts - 1) / parts, 1),
            std::min<uint64_t>(plan.pool_bytes / kPagesAtOnce,
                               uint64_t(OVC_MAX_UNITS) * OVC_UNIT_BYTES)};
}

Result<Done> check_count(const Soup& soup) {
    if (soup.triangle_count() > OVC_MAX_TRIANGLES)
        return Error{fmt::format("{} triangles are too many: a scene takes {}",
                                 soup.triangle_count(), OVC_MAX_TRIANGLES)};
    return Done{};
}

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log, BuildProgress* progress) {
    const Result<MemoryPlan> plan = plan_memory(budget_of(options, gl.info()), gl.info());
    if (!plan)
        return plan.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(soup, gl, options, *plan));

    if (const Result<Done> fine = check_count(soup); !fine)
        return fine.error();
    const Stopwatch watch;
    begin(progress, "triangles", 0.1, 2 * soup.triangle_count());
    Box bounds;
    TwoLevelStatistics& statistics = self->statistics_;
    std::vector<TriangleId> triangles =
        hittable_triangles(soup, &statistics.dropped, &bounds, progress);
    if (statistics.dropped.not_finite)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner",
                        statistics.dropped.not_finite));
    if (statistics.dropped.degenerate)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles without area", statistics.dropped.degenerate));
    self->twins_ = Twins::take_out(soup, triangles, progress);
    statistics.twins = self->twins_.count();
    statistics.seconds_level1 = watch.seconds();

    self->numbers_ = Numbering(soup);
    Result<Levels> levels = build_levels(soup, self->numbers_, triangles, bounds,
                                         limits_of(options, *plan, triangles.size()), progress);
    if (!levels)
        return levels.error();
    self->level1_ = std::move(levels->level1);
    self->pages_ = std::move(levels->pages);
    statistics.seconds_level1 += levels->seconds_level1;
    statistics.seconds_level2 += levels->seconds_level2;
    for (const Page& page : self->pages_) {
        statistics.level2_bytes += page.bytes();
        statistics.largest_page_bytes = std::max(statistics.largest_page_bytes, page.bytes());
    }
    statistics.host_bytes =
        statistics.level2_bytes + self->level1_.reference_count() * sizeof(TriangleId) +
        self->level1_.leaves.size() * sizeof(Leaf) + self->level1_.nodes.size() * sizeof(KdNode);
    if (self->pages_.empty())
        return self; // every ray misses, no GPU needed
    if (const Result<Done> shared = self->share_out(); !shared)
        return shared.error();

    Result<std::unique_ptr<Tracer>> tracer = Error{};
    gl.run([&](GlState& state) {
        tracer = Tracer::create(self->plan_, gl.info(), state.kernels, self->level1_, self->pages_);
    });
    if (!tracer)
        return tracer.error();
    self->tracer_ = std::move(*tracer);
    self->bring_first(progress);
    statistics.peak_bytes = self->tracer_->ledger().peak;
    return self;
}

/// Moves in the first pages, as many as fit, so that rays need not come and wait first.
void TwoLevel::bring_first(BuildProgress* progress) {
    constexpr uint64_t kBytesAtOnce = 32 << 20; // between two looks whether to stop
    begin(progress, "moving pages to the GPU", 0.05, plan_.pool_bytes);
    uint64_t room = plan_.pool_bytes;
    for (size_t next = 0; next < pages_.size() && pages_[next].bytes() <= room;) {
        std::vector<uint32_t> some;
        uint64_t bytes = 0;
        for (; next < pages_.size() && pages_[next].bytes() <= room && bytes < kBytesAtOnce;
             ++next) {
            some.push_back(uint32_t(next));
            bytes += pages_[next].bytes();
            room -= pages_[next].bytes();
        }
        bring(some);
        add(progress, bytes);
    }
}

TwoLevel::~TwoLevel() {
    if (tracer_)
        gl_.run([&](GlState&) { tracer_.reset(); });
}

/// Takes level 1 off the pool, and what no page needs.
Result<Done> TwoLevel::share_out() {
    const uint64_t table = level1_texels(level1_) * sizeof(uvec4);
    const uint64_t needed = table + statistics_.largest_page_bytes;
    if (plan_.pool_bytes < needed)
        return Error{fmt::format(
            "a GPU budget of {} bytes is too small for this scene: the smallest that works is {} "
            "bytes ({} for level 1 with {} leaves, {} for the largest page, an eighth for rays)",
            plan_.budget_bytes, (needed + plan_.ray_bytes()) / 7 * 8 + 8, table,
            level1_.leaves.size(), statistics_.largest_page_bytes)};
    plan_.pool_bytes = std::min(plan_.pool_bytes - table, statistics_.level2_bytes);
    return Done{};
}

/// Moves the first pages of `wanted` in, as many as fit; returns how many.
size_t TwoLevel::bring(std::span<const uint32_t> wanted) {
    Moved moved;
    gl_.run([&](GlState&) { moved = tracer_->bring(wanted); });
    statistics_.pages_in += moved.pages;
    statistics_.bytes_in += moved.bytes;
    return moved.pages;
}

/// The number of a triangle that a ray shall not see; OVC_NO_TRIANGLE where it stands for others,
/// which are to be found.
uint32_t TwoLevel::number_to_skip(TriangleId id) const {
    return id.mesh == kNone || twins_.stands_for_others(id) ? OVC_NO_TRIANGLE : numbers_.of(id);
}

/// The first `count` travellers on their way; their answers into answers_.
Result<Done> TwoLevel::pass(size_t count) {
    const size_t padded = Tracer::row_padded(count);
    const Traveller none{{dvec3(0), 0, dvec3(0, 0, 1), -1}, 0, OVC_NO_TRIANGLE, OVC_NO_LEAF};
    travellers_.resize(padded);
    std::fill(travellers_.begin() + ptrdiff_t(count), travellers_.end(), none);
    answers_.resize(padded);
    Result<double> seconds = Error{};
    gl_.run([&](GlState&) {
        seconds =
            tracer_->pass({options_.certify, options_.compute}, std::span(travellers_).first(count),
                          std::span(answers_).first(count));
    });
    if (!seconds)
        return seconds.error();
    statistics_.passes += 1;
    statistics_.ray_visits += count;
    statistics_.seconds_kernel += *seconds;
    return Done{};
}

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const Stopwatch watch;
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        Wave<Query> wave(*this, query.part(first, count));
        std::vector<uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        wave.start(all);
        while (wave.ready() + wave.waiting() > 0)
            if (Result<Done> done = round(wave); !done)
                return done;
        (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += count;
    }
    statistics_.seconds_trace += watch.seconds();
    return Done{};
}

Result<Done> TwoLevel::intersect(std::span<const Ray> rays, std::span<const TriangleId> skip,
                                 std::span<Hit> hits) {
    return trace(NearestQuery{rays, skip, hits});
}

Result<Done> TwoLevel::occluded(std::span<const Ray> rays, std::span<const TriangleId> skip,
                                std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, skip, occluded});
}

} // namespace ovc
