// SPDX-License-Identifier: Apache-2.0
// Two-level: building, and the loop over passes.
#include "plugin/two_level.h"

#include "core/parallel.h"
#include "plugin/arbiter.h"
#include "plugin/level2.h"
#include "plugin/query.h"
#include "plugin/queues.h"
#include "plugin/rebase.h"
#include "shaders/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>

namespace ovc {
namespace {

constexpr size_t kGrain = 256;         // rays a task
constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
constexpr uint64_t kPagesAtOnce =
    3; // a page takes at most this share of the pool, so that some stay resident
constexpr double kFastSlack = 0x1p-20;  // of a leaf: 16 roundings
constexpr uint64_t kDefaultLeaves = 10; // thesis, section 4

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

uint64_t align(uint64_t bytes, uint64_t alignment) {
    return (bytes + alignment - 1) / alignment * alignment;
}

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

    const auto start = std::chrono::steady_clock::now();
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
    statistics.seconds_level1 = seconds_since(start);

    const uint64_t parts = options.leaves ? options.leaves : kDefaultLeaves;
    const uint64_t most = options.leaf_triangles
                              ? options.leaf_triangles
                              : std::max<uint64_t>((triangles.size() + parts - 1) / parts, 1);
    const uint64_t page_bytes = std::min<uint64_t>(plan->pool_bytes / kPagesAtOnce,
                                                   uint64_t(OVC_MAX_UNITS) * OVC_UNIT_BYTES);
    Result<Levels> levels = build_levels(soup, triangles, bounds, most, page_bytes);
    if (!levels)
        return levels.error();
    self->level1_ = std::move(levels->level1);
    self->pages_ = std::move(levels->pages);
    statistics.seconds_level1 += levels->seconds_level1;
    statistics.seconds_level2 += levels->seconds_level2;
    uint64_t all_pages = gl.info().buffer_alignment; // a pool of nothing is no buffer
    for (const Page& page : self->pages_) {
        all_pages += align(page.bytes(), gl.info().buffer_alignment);
        statistics.level2_bytes += page.bytes();
        statistics.largest_page_bytes = std::max(statistics.largest_page_bytes, page.bytes());
    }

    self->plan_.pool_bytes = std::min(plan->pool_bytes, all_pages);

    Result<std::unique_ptr<Tracer>> tracer = Error{};
    gl.run([&](GlState& state) {
        tracer = Tracer::create(self->plan_, gl.info(), state.kernels, self->pages_.size());
    });
    if (!tracer)
        return tracer.error();
    self->tracer_ = std::move(*tracer);
    statistics.peak_bytes = self->tracer_->ledger().peak;
    return self;
}

TwoLevel::~TwoLevel() {
    gl_.run([&](GlState&) { tracer_.reset(); });
}

/// Some rays of a call on their way through the leaves, until none waits any more.
template <class Query>
class TwoLevel::Wave {
public:
    Wave(TwoLevel& structure, const Query& query, size_t first, size_t count)
        : s_(structure),
          query_(query),
          first_(first),
          positions_(count),
          next_(count, kNone),
          queues_(structure.level1_.leaves.size()),
          rays_(Tracer::row_padded(std::min<size_t>(structure.plan_.batch_rays, count))),
          answers_(rays_.size()),
          decidable_(rays_.size()) {}

    Result<Done> run() {
        start();
        for (uint32_t leaf; (leaf = queues_.choose(*s_.tracer_, s_.pages_)) != kNone;) {
            const std::vector<uint32_t> queue = queues_.take(leaf);
            const size_t most = s_.plan_.batch_rays;
            for (size_t at = 0; at < queue.size(); at += most)
                if (Result<Done> done =
                        pass(leaf, std::span(queue).subspan(at, std::min(most, queue.size() - at)));
                    !done)
                    return done;
        }
        s_.statistics_.invalid_rays += invalid_;
        s_.statistics_.flagged += flagged_;
        s_.statistics_.retraced += retraced_;
        s_.statistics_.capped += capped_;
        return Done{};
    }

private:
    /// Finds the first leaf of each ray.
    void start() {
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
                positions_[i] = {p.ray.t_min};
                if (can_walk(s_.level1_, p))
                    next_[i] = next_leaf(s_.level1_, p, positions_[i]).leaf;
                else
                    decide_in_double(i, p);
            }
        });
        enqueue(all);
    }

    /// Traces a batch of the leaf's queue and sends its rays on.
    Result<Done> pass(uint32_t leaf, std::span<const uint32_t> batch) {
        rebase_all(leaf, batch);
        Result<PassResult> pass = Error{};
        s_.gl_.run([&](GlState&) {
            pass = s_.tracer_->pass(
                leaf, s_.pages_[leaf], {Query::kAnyHit, s_.options_.certify, s_.options_.compute},
                std::span(rays_).first(batch.size()), std::span(answers_).first(batch.size()));
        });
        if (!pass)
            return pass.error();
        TwoLevelStatistics& statistics = s_.statistics_;
        statistics.passes += 1;
        statistics.pages_in += pass->bytes_in > 0;
        statistics.bytes_in += pass->bytes_in;
        statistics.ray_visits += batch.size();
        statistics.seconds_kernel += pass->seconds;
        settle_all(leaf, batch);
        enqueue(batch);
        return Done{};
    }

    void rebase_all(uint32_t leaf, std::span<const uint32_t> batch) {
        const size_t padded = Tracer::row_padded(batch.size());
        parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j) {
                PreparedRay p = prepare_rest(query_, first_ + batch[j]);
                if (s_.twins_.stands_for_others(p.skip))
                    p.skip = {}; // the others are to be found
                bool decidable;
                rays_[j] = rebase(s_.level1_.leaves[leaf], p, decidable);
                decidable_[j] = decidable;
            }
        });
        std::fill(rays_.begin() + ptrdiff_t(batch.size()), rays_.begin() + ptrdiff_t(padded),
                  no_ray());
    }

    void settle_all(uint32_t leaf, std::span<const uint32_t> batch) {
        parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
            for (size_t j = from; j < to; ++j)
                settle(leaf, batch[j], answers_[j], decidable_[j]);
        });
    }

    /// Takes in the kernel's answer for ray i, and says in next_[i] where the ray goes from here.
    void settle(uint32_t leaf, uint32_t i, const LocalAnswer& answer, bool decidable) {
        const size_t ray = first_ + i;
        const PreparedRay p = prepare(query_, ray);
        next_[i] = kNone;
        capped_ += decidable && answer.prim == OVC_CAPPED;
        if (!decidable || answer.prim == OVC_FLAGGED || answer.prim == OVC_CAPPED ||
            !take_in(leaf, ray, p, answer))
            decide_in_double(i, p);
        else if (!query_.was_hit(ray))
            next_[i] = next_leaf(s_.level1_, p, positions_[i]).leaf;
        else if (!Query::kAnyHit)
            next_[i] = next_leaf_in_cell(s_.level1_, prepare_rest(query_, ray), positions_[i]).leaf;
    }

    /// Enters what the kernel found in the leaf. False when double does not find what the kernel
    /// was certain of.
    bool take_in(uint32_t leaf_index, size_t ray, const PreparedRay& p, const LocalAnswer& answer) {
        const Leaf& leaf = s_.level1_.leaves[leaf_index];
        if (!s_.options_.certify) {
            take_in_fast(leaf, ray, answer);
            return true;
        }
        const bool has_rivals = answer.rivals()[0] != OVC_NO_TRIANGLE;
        flagged_ += has_rivals;
        if (Query::kAnyHit && !has_rivals && answer.prim != OVC_MISS) {
            query_.set(ray, Hit{0, 0, 0, leaf.triangles[answer.prim]}); // a certain hit decides
            return true;
        }
        Nearest nearest(p);
        if (query_.was_hit(ray))
            offer(nearest, query_.hit(ray).id, p.skip);
        if (answer.prim != OVC_MISS && !offer(nearest, leaf.triangles[answer.prim], p.skip))
            return false;
        for (const uint32_t rival : answer.rivals())
            if (rival != OVC_NO_TRIANGLE)
                offer(nearest, leaf.triangles[rival], p.skip);
        if (nearest.hit().is_hit() && counts(leaf, p, nearest.hit().t))
            query_.set(ray, nearest.hit());
        return true;
    }

    /// Is the hit in the leaf's cell, or beyond by no more than `slack`? Farther, a nearer one may
    /// be in the next leaf, which will find this one too.
    static bool counts(const Leaf& leaf, const PreparedRay& p, double t, double slack = 0) {
        return t <= clip(p, leaf.cell.padded(slack), p.ray.t_min, p.ray.t_max).exit;
    }

    void take_in_fast(const Leaf& leaf, size_t ray, const LocalAnswer& answer) {
        if (answer.prim == OVC_MISS)
            return;
        const PreparedRay p = prepare(query_, ray);
        const double t = world_t(leaf, prepare_rest(query_, ray), answer.t());
        const Hit hit = s_.twins_.seen(
            s_.soup_, {t, answer.u(), answer.v(), leaf.triangles[answer.prim]}, p.skip);
        // t is as good as float is: what lies on the last plane of the scene may come out behind
        // it.
        if (counts(leaf, p, t, kFastSlack / leaf.frame.scale) &&
            (!query_.was_hit(ray) || hit.nearer_than(query_.hit(ray))))
            query_.set(ray, hit);
    }

    /// Offers what stands in the leaf as `id`.
    bool offer(Nearest& nearest, TriangleId id, TriangleId skip) const {
        const TriangleId seen = s_.twins_.seen(id, skip);
        return nearest.offer(s_.soup_.triangle(seen), seen);
    }

    void decide_in_double(size_t i, const PreparedRay& p) {
        query_.set(first_ + i,
                   arbitrate<Query::kAnyHit>(s_.soup_, s_.twins_, s_.level1_, s_.pages_, p));
        ++flagged_;
        ++retraced_;
    }

    void enqueue(std::span<const uint32_t> rays) {
        for (const uint32_t i : rays)
            if (next_[i] != kNone)
                queues_.push(next_[i], i);
    }

    TwoLevel& s_;
    const Query& query_;
    const size_t first_;                 // of the call's rays; indices below count from it
    std::vector<RayPosition> positions_; // per ray
    std::vector<uint32_t> next_;         // per ray: the leaf it goes to
    Queues queues_;
    std::vector<LocalRay> rays_; // per ray of a batch, as are the next two
    std::vector<LocalAnswer> answers_;
    std::vector<uint8_t> decidable_;
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const auto start = std::chrono::steady_clock::now();
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        if (Result<Done> done = Wave<Query>(*this, query, first, count).run(); !done)
            return done;
        (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += count;
    }
    statistics_.seconds_trace += seconds_since(start);
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
