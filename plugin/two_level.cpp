// SPDX-License-Identifier: Apache-2.0
// Two-level: building, and the loop over passes.
#include "plugin/two_level.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gpu/level1_table.h"
#include "kdtree/restart.h"
#include "plugin/arbiter.h"
#include "plugin/level2.h"
#include "plugin/query.h"
#include "plugin/waiting.h"
#include "shaders/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <numeric>

namespace ovc {
namespace {

constexpr size_t kGrain = 256;         // rays a task
constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
constexpr uint64_t kPagesAtOnce =
    3; // a page takes at most this share of the pool, so that some stay resident
constexpr size_t kFewRays = 4096;       // fewer are not worth a pass while others wait
constexpr uint64_t kDefaultLeaves = 10; // thesis, section 4

} // namespace

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log) {
    const uint64_t budget =
        options.budget_bytes ? options.budget_bytes : gl.info().default_budget_bytes();
    const Result<MemoryPlan> plan = plan_memory(budget, gl.info());
    if (!plan)
        return plan.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(soup, gl, options, *plan));

    if (soup.triangle_count() > OVC_MAX_TRIANGLES)
        return Error{fmt::format("{} triangles are too many: a scene takes {}",
                                 soup.triangle_count(), OVC_MAX_TRIANGLES)};
    const Stopwatch watch;
    Box bounds;
    TwoLevelStatistics& statistics = self->statistics_;
    std::vector<TriangleId> triangles = hittable_triangles(soup, &statistics.dropped, &bounds);
    if (statistics.dropped.not_finite)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner",
                        statistics.dropped.not_finite));
    if (statistics.dropped.degenerate)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles without area", statistics.dropped.degenerate));
    self->twins_ = Twins::take_out(soup, triangles);
    statistics.twins = self->twins_.count();
    statistics.seconds_level1 = watch.seconds();

    const uint64_t parts = options.leaves ? options.leaves : kDefaultLeaves;
    const uint64_t most = options.leaf_triangles
                              ? options.leaf_triangles
                              : std::max<uint64_t>((triangles.size() + parts - 1) / parts, 1);
    const uint64_t page_bytes = std::min<uint64_t>(plan->pool_bytes / kPagesAtOnce,
                                                   uint64_t(OVC_MAX_UNITS) * OVC_UNIT_BYTES);
    self->numbers_ = Numbering(soup);
    Result<Levels> levels = build_levels(soup, self->numbers_, triangles, bounds, most, page_bytes);
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
    std::vector<uint32_t> all(self->pages_.size());
    std::iota(all.begin(), all.end(), 0u);
    self->bring(all); // as many as fit, so that rays need not come and wait first
    statistics.peak_bytes = self->tracer_->ledger().peak;
    return self;
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

/// Some rays of a call on their way through the leaves, until none is under way any more.
template <class Query>
class TwoLevel::Wave {
public:
    Wave(TwoLevel& structure, const Query& query, size_t first, size_t count)
        : s_(structure),
          query_(query),
          first_(first),
          positions_(count),
          waiting_(structure.level1_.leaves.size()),
          used_(structure.level1_.leaves.size()),
          travellers_(Tracer::row_padded(std::min<size_t>(structure.plan_.batch_rays, count))),
          answers_(travellers_.size()) {}

    Result<Done> run() {
        start();
        // What is ready goes with the next pass, whose greater part then comes from the pages moved
        // in: so every pass gets somewhere, though those pages may push out what was ready for.
        const size_t few = std::min<size_t>(kFewRays, s_.plan_.batch_rays / 4);
        while (true) {
            if (ready_.size() < few && waiting_.count() > 0)
                bring();
            if (ready_.empty())
                break;
            if (Result<Done> done = pass(); !done)
                return done;
        }
        s_.statistics_.invalid_rays += invalid_;
        s_.statistics_.flagged += flagged_;
        s_.statistics_.retraced += retraced_;
        s_.statistics_.capped += capped_;
        return Done{};
    }

private:
    /// Where a ray stands; t_from and leaf as in Traveller. Nothing beyond t_end is of interest.
    struct Position {
        double t_from = 0;
        double t_end = 0;
        uint32_t leaf = OVC_NO_LEAF;
        enum : uint32_t { Done, Ready, Waits } state = Done;
    };

    void start() {
        const Box scene = s_.level1_.bounds.padded(s_.level1_.padding); // empty: no triangles
        std::vector<uint32_t> all(positions_.size());
        parallel_for(all.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i) {
                all[i] = uint32_t(i);
                query_.set_miss(first_ + i);
                if (!query_.rays[first_ + i].valid()) {
                    ++invalid_;
                    continue;
                }
                const PreparedRay p = prepare(query_, first_ + i);
                if (clip(p, scene, p.ray.t_min, p.ray.t_max).empty())
                    continue;
                if (can_walk(s_.level1_, p))
                    positions_[i] = {p.ray.t_min, p.ray.t_max, OVC_NO_LEAF, Position::Ready};
                else
                    decide_in_double(i, p);
            }
        });
        send_on(all);
    }

    void send_on(std::span<const uint32_t> rays) {
        for (const uint32_t i : rays) {
            if (positions_[i].state == Position::Ready)
                ready_.push_back(i);
            else if (positions_[i].state == Position::Waits)
                waiting_.push(positions_[i].leaf, i);
        }
    }

    /// Moves pages in and calls up who waited for them.
    void bring() {
        const std::vector<uint32_t> wanted = waiting_.wanted(s_.pages_);
        const size_t moved = s_.bring(wanted);
        for (size_t i = 0; i < moved; ++i)
            for (const uint32_t ray : waiting_.take(wanted[i]))
                ready_.push_back(ray);
    }

    /// Walks a batch of the rays that are ready, takes in the answers, and sends the rays on.
    Result<Done> pass() {
        const size_t count = std::min<size_t>(ready_.size(), s_.plan_.batch_rays);
        const std::vector<uint32_t> batch(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        ready_.erase(ready_.begin(), ready_.begin() + ptrdiff_t(count));
        load(batch);
        Result<double> seconds = Error{};
        s_.gl_.run([&](GlState&) {
            seconds = s_.tracer_->pass({Query::kAnyHit, s_.options_.certify, s_.options_.compute},
                                       std::span(travellers_).first(count),
                                       std::span(answers_).first(count));
        });
        if (!seconds)
            return seconds.error();
        s_.statistics_.passes += 1;
        s_.statistics_.ray_visits += count;
        s_.statistics_.seconds_kernel += *seconds;
        parallel_for(count, kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                settle(batch[j], answers_[j]);
        });
        for (uint32_t leaf = 0; leaf < used_.size(); ++leaf)
            if (used_[leaf].exchange(0, std::memory_order_relaxed))
                s_.tracer_->touch(leaf);
        send_on(batch);
        return Done{};
    }

    void load(std::span<const uint32_t> batch) {
        parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                const size_t ray = first_ + batch[j];
                const Position& at = positions_[batch[j]];
                Ray rest = query_.rays[ray];
                rest.t_max = at.t_end;
                travellers_[j] = {rest, at.t_from, s_.number_to_skip(query_.skipped(ray)), at.leaf};
            }
        });
        const Traveller none{{dvec3(0), 0, dvec3(0, 0, 1), -1}, 0, OVC_NO_TRIANGLE, OVC_NO_LEAF};
        std::fill(travellers_.begin() + ptrdiff_t(batch.size()),
                  travellers_.begin() + ptrdiff_t(Tracer::row_padded(batch.size())), none);
    }

    /// Takes in the kernel's answer for ray i, and says in positions_[i] where the ray goes from
    /// here.
    void settle(uint32_t i, const Answer& answer) {
        positions_[i].state = Position::Done;
        if (answer.prim == OVC_WAITS) {
            positions_[i] = {answer.t(), positions_[i].t_end, answer.leaf(), Position::Waits};
            return;
        }
        const bool decided = answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
        capped_ += answer.prim == OVC_CAPPED;
        if (!decided || !(s_.options_.certify ? take_in(i, answer) : take_in_fast(i, answer)))
            decide_in_double(i, prepare(query_, first_ + i));
    }

    /// Enters what the kernel found. False where double does not find what the kernel was certain
    /// of, or cannot say where to go on.
    bool take_in(uint32_t i, const Answer& answer) {
        const size_t ray = first_ + i;
        const bool has_rivals = answer.rivals()[0] != OVC_NO_TRIANGLE;
        if (answer.prim == OVC_MISS && !has_rivals)
            return true;
        const uint32_t leaf = answer.leaf();
        if (used_[leaf].load(std::memory_order_relaxed) == 0)
            used_[leaf].store(1, std::memory_order_relaxed);
        if (Query::kAnyHit && !has_rivals) {
            query_.set(ray, Hit{0, 0, 0, s_.numbers_.id(answer.prim)}); // a certain hit decides
            return true;
        }
        const PreparedRay p = prepare(query_, ray);
        Nearest nearest(p);
        if (query_.was_hit(ray))
            offer(nearest, s_.numbers_.of(query_.hit(ray).id), p.skip);
        if (answer.prim != OVC_MISS && !offer(nearest, answer.prim, p.skip))
            return false;
        for (const uint32_t rival : answer.rivals())
            if (rival != OVC_NO_TRIANGLE)
                offer(nearest, rival, p.skip);
        if (nearest.hit().is_hit())
            query_.set(ray, nearest.hit());
        const bool settled =
            (Query::kAnyHit && nearest.hit().is_hit()) || go_on_behind(i, leaf, p, nearest.limit());
        flagged_ += settled && has_rivals; // decide_in_double() counts the others
        return settled;
    }

    /// Sends the ray on unless its best hit, which is not beyond `end` however t is rounded, lies
    /// in the leaf's cell: then nothing of later cells is nearer, nor as near. False where rounding
    /// would send it back: t must grow, or two cells at a corner pass a ray to and fro.
    bool go_on_behind(uint32_t i, uint32_t leaf, const PreparedRay& p, double end) {
        const Box& cell = s_.level1_.leaves[leaf].cell;
        const Box safe = cell.padded(-p.margin(cell)); // no rounding leads out of the cell
        const double exit = clip(p, cell, p.ray.t_min, p.ray.t_max).exit;
        if (end <= clip(p, safe, p.ray.t_min, p.ray.t_max).exit || exit >= end)
            return true;
        if (exit <= positions_[i].t_from)
            return false;
        positions_[i] = {exit, end, leaf + 1, Position::Ready};
        return true;
    }

    bool take_in_fast(uint32_t i, const Answer& answer) {
        const size_t ray = first_ + i;
        if (answer.prim != OVC_MISS)
            query_.set(ray, s_.twins_.seen(
                                s_.soup_,
                                {answer.t(), answer.u(), answer.v(), s_.numbers_.id(answer.prim)},
                                query_.skipped(ray)));
        return true;
    }

    /// Offers what stands in the page as `number`.
    bool offer(Nearest& nearest, uint32_t number, TriangleId skip) const {
        const TriangleId seen = s_.twins_.seen(s_.numbers_.id(number), skip);
        return nearest.offer(s_.soup_.triangle(seen), seen);
    }

    void decide_in_double(size_t i, const PreparedRay& p) {
        query_.set(first_ + i, arbitrate<Query::kAnyHit>(s_.soup_, s_.numbers_, s_.twins_,
                                                         s_.level1_, s_.pages_, p));
        ++flagged_;
        ++retraced_;
    }

    TwoLevel& s_;
    const Query& query_;
    const size_t first_;              // of the call's rays; indices below count from it
    std::vector<Position> positions_; // per ray
    std::vector<uint32_t> ready_;     // rays for the next passes
    Waiting waiting_;
    std::vector<std::atomic<uint8_t>> used_; // per leaf: a ray of the last pass ended there
    std::vector<Traveller> travellers_;      // per ray of a batch, as are the answers
    std::vector<Answer> answers_;
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

/// The number of a triangle that a ray shall not see; OVC_NO_TRIANGLE where it stands for others,
/// which are to be found.
uint32_t TwoLevel::number_to_skip(TriangleId id) const {
    return id.mesh == kNone || twins_.stands_for_others(id) ? OVC_NO_TRIANGLE : numbers_.of(id);
}

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const Stopwatch watch;
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        if (Result<Done> done = Wave<Query>(*this, query, first, count).run(); !done)
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
