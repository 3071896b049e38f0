// SPDX-License-Identifier: Apache-2.0
// Two-level: queues, the choice of the next leaf, re-basing, settling.
#include "plugin/two_level.h"

#include "core/parallel.h"
#include "plugin/arbiter.h"
#include "plugin/level2.h"
#include "shaders/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <optional>

namespace ovc {
namespace {

constexpr size_t kGrain = 256;         // rays a task
constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
constexpr uint64_t kPagesAtOnce =
    3; // a page takes at most this share of the pool, so that some stay resident
constexpr uint64_t kDefaultLeaves = 10;   // thesis, section 4
constexpr double kMostLeafSizes = 0x1p24; // see rebase()

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

uint64_t align(uint64_t bytes, uint64_t alignment) {
    return (bytes + alignment - 1) / alignment * alignment;
}

/// The ray in the leaf's frame, from where it enters the leaf's box; no value where double
/// precision cannot say where that is to within a sixteenth of a float rounding.
std::optional<LocalRay> rebase(const Leaf& leaf, const PreparedRay& p) {
    const Interval inside = clip(p, leaf.box, p.ray.t_min, p.ray.t_max);
    if (inside.empty())
        return LocalRay{vec3(0), -1, vec3(0, 0, 1), OVC_NO_TRIANGLE};
    const dvec3 travelled = p.ray.dir * inside.enter;
    const double reach = std::max(max_component(glm::abs(p.ray.org - leaf.frame.origin)),
                                  max_component(glm::abs(travelled)));
    const double speed = std::abs(p.ray.dir[p.kz]) * leaf.frame.scale;
    const double length = (inside.exit - inside.enter) * speed;
    if (!(reach * leaf.frame.scale <= kMostLeafSizes) || !std::isfinite(length) ||
        !std::isfinite(speed) || speed < 1e-300)
        return std::nullopt;
    const dvec3 local = ((p.ray.org - leaf.frame.origin) + travelled) * leaf.frame.scale;
    uint32_t skip = OVC_NO_TRIANGLE;
    if (p.skip.mesh != kNone) {
        const auto at = std::lower_bound(leaf.triangles.begin(), leaf.triangles.end(), p.skip);
        if (at != leaf.triangles.end() && *at == p.skip)
            skip = uint32_t(at - leaf.triangles.begin());
    }
    return LocalRay{vec3(local), std::nextafter(float(length), INFINITY),
                    vec3(p.ray.dir / std::abs(p.ray.dir[p.kz])), skip};
}

/// What the two kinds of query differ in: the kernel, and what becomes of an answer.
struct NearestQuery {
    static constexpr bool kAnyHit = false;
    std::span<const Ray> rays;
    std::span<const TriangleId> skip;
    std::span<Hit> results;

    void miss(size_t i) const { results[i] = Hit{}; }
    void arbitrated(size_t i, const Hit& hit) const { results[i] = hit; }
    /// The answer in double from the original triangle; false when double does not confirm it.
    bool settle(size_t i, const PreparedRay& p, const Soup& soup, TriangleId id) const {
        const std::optional<Hit> hit = ovc::intersect(p, soup.triangle(id), id);
        if (hit && hit->nearer_than(results[i]))
            results[i] = *hit;
        return hit.has_value();
    }
    bool was_hit(size_t i) const { return results[i].is_hit(); }
    /// The end of ray i as far as it is still of interest.
    double t_max(size_t i) const { return std::min(rays[i].t_max, results[i].t); }
};

struct OcclusionQuery {
    static constexpr bool kAnyHit = true;
    std::span<const Ray> rays;
    std::span<const TriangleId> skip;
    std::span<uint8_t> results;

    void miss(size_t i) const { results[i] = 0; }
    void arbitrated(size_t i, const Hit& hit) const { results[i] = hit.is_hit(); }
    /// A certain hit decides, whichever triangle it is.
    bool settle(size_t i, const PreparedRay&, const Soup&, TriangleId) const {
        results[i] = 1;
        return true;
    }
    bool was_hit(size_t i) const { return results[i]; }
    double t_max(size_t i) const { return rays[i].t_max; }
};

/// Ray i as the host gave it.
template <class Query>
PreparedRay prepare(const Query& query, size_t i) {
    return PreparedRay(query.rays[i], query.skip.empty() ? TriangleId{} : query.skip[i]);
}

/// Ray i as far as it is still of interest: up to the best hit so far.
template <class Query>
PreparedRay prepare_rest(const Query& query, size_t i) {
    PreparedRay p = prepare(query, i);
    p.ray.t_max = query.t_max(i);
    return p;
}

/// Ray indices that wait for each leaf, and which leaf is next.
class Queues {
public:
    explicit Queues(size_t leaves) : waiting_(leaves) {}

    void push(uint32_t leaf, uint32_t ray) { waiting_[leaf].push_back(ray); }
    std::vector<uint32_t> take(uint32_t leaf) { return std::exchange(waiting_[leaf], {}); }

    /// The resident leaf with most rays; else the leaf with most rays per byte to move; kNone when
    /// nobody waits.
    uint32_t choose(const Tracer& tracer, const std::vector<Page>& pages) const {
        uint32_t best = kNone;
        bool best_resident = false;
        double best_worth = 0;
        for (uint32_t leaf = 0; leaf < waiting_.size(); ++leaf) {
            if (waiting_[leaf].empty())
                continue;
            const bool resident = tracer.resident(leaf);
            const double rays = double(waiting_[leaf].size());
            const double worth = resident ? rays : rays / double(pages[leaf].bytes());
            if (resident == best_resident ? worth > best_worth : resident) {
                best = leaf;
                best_resident = resident;
                best_worth = worth;
            }
        }
        return best;
    }

private:
    std::vector<std::vector<uint32_t>> waiting_;
};

} // namespace

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log) {
    const uint64_t budget =
        options.budget_bytes ? options.budget_bytes : gl.info().default_budget_bytes();
    const Result<MemoryPlan> plan = plan_memory(budget, gl.info());
    if (!plan)
        return plan.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(soup, gl, *plan));

    const auto start = std::chrono::steady_clock::now();
    Box bounds;
    TwoLevelStatistics& statistics = self->statistics_;
    const std::vector<TriangleId> triangles =
        hittable_triangles(soup, &statistics.dropped, &bounds);
    if (statistics.dropped.not_finite)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles with a NaN or infinite corner",
                        statistics.dropped.not_finite));
    if (statistics.dropped.degenerate)
        say(log, LogLevel::Warning,
            fmt::format("left out {} triangles without area", statistics.dropped.degenerate));
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

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const auto start = std::chrono::steady_clock::now();
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays)
        if (Result<Done> wave =
                trace_wave(query, first, std::min(query.rays.size(), first + kWaveRays));
            !wave)
            return wave;
    statistics_.seconds_trace += seconds_since(start);
    return Done{};
}

template <class Query>
Result<Done> TwoLevel::trace_wave(const Query& query, size_t first, size_t last) {
    const size_t count = last - first;
    std::vector<RayPosition> positions(count);
    std::vector<uint32_t> next(count, kNone); // the leaf a ray goes to
    std::atomic<uint64_t> invalid{0}, flagged{0};
    const auto decide_in_double = [&](size_t i, const PreparedRay& p) {
        query.arbitrated(first + i, arbitrate<Query::kAnyHit>(soup_, level1_, pages_, p));
        ++flagged;
    };

    parallel_for(count, kGrain, [&](size_t from, size_t to) {
        for (size_t i = from; i < to; ++i) {
            query.miss(first + i);
            if (!query.rays[first + i].valid()) {
                ++invalid;
                continue;
            }
            const PreparedRay p = prepare(query, first + i);
            positions[i] = {p.ray.t_min};
            if (can_walk(level1_, p))
                next[i] = next_leaf(level1_, p, positions[i]).leaf;
            else
                decide_in_double(i, p);
        }
    });
    Queues queues(level1_.leaves.size());
    for (uint32_t i = 0; i < count; ++i)
        if (next[i] != kNone)
            queues.push(next[i], i);

    std::vector<LocalRay> rays(Tracer::row_padded(std::min<size_t>(plan_.batch_rays, count)));
    std::vector<LocalAnswer> answers(rays.size());
    for (uint32_t leaf; (leaf = queues.choose(*tracer_, pages_)) != kNone;) {
        const std::vector<uint32_t> queue = queues.take(leaf);
        for (size_t at = 0; at < queue.size(); at += plan_.batch_rays) {
            const std::span<const uint32_t> batch =
                std::span(queue).subspan(at, std::min<size_t>(plan_.batch_rays, queue.size() - at));
            parallel_for(Tracer::row_padded(batch.size()), kGrain, [&](size_t from, size_t to) {
                for (size_t j = from; j < to; ++j) {
                    rays[j].t_end = -1;
                    if (j >= batch.size())
                        continue;
                    if (const auto ray =
                            rebase(level1_.leaves[leaf], prepare_rest(query, first + batch[j])))
                        rays[j] = *ray;
                    else
                        rays[j].skip = OVC_FLAGGED; // undecided before the kernel saw it
                }
            });
            const Result<PassResult> pass = gl_.run([&](GlState&) {
                return tracer_->pass(leaf, pages_[leaf], Query::kAnyHit,
                                     std::span(rays).first(batch.size()),
                                     std::span(answers).first(batch.size()));
            });
            if (!pass)
                return pass.error();
            statistics_.passes += 1;
            statistics_.pages_in += pass->bytes_in > 0;
            statistics_.bytes_in += pass->bytes_in;
            statistics_.ray_visits += batch.size();
            statistics_.seconds_kernel += pass->seconds;

            parallel_for(batch.size(), kGrain, [&](size_t from, size_t to) {
                for (size_t j = from; j < to; ++j) {
                    const uint32_t i = batch[j];
                    const PreparedRay p = prepare(query, first + i);
                    const bool undecided = rays[j].t_end < 0 && rays[j].skip == OVC_FLAGGED;
                    const uint32_t prim = undecided ? OVC_FLAGGED : answers[j].prim;
                    next[i] = kNone;
                    if (prim == OVC_FLAGGED ||
                        (prim != OVC_MISS &&
                         !query.settle(first + i, p, soup_, level1_.leaves[leaf].triangles[prim])))
                        decide_in_double(i, p);
                    else if (!query.was_hit(first + i))
                        next[i] = next_leaf(level1_, p, positions[i]).leaf;
                    else if (!Query::kAnyHit)
                        next[i] =
                            next_leaf_in_cell(level1_, prepare_rest(query, first + i), positions[i])
                                .leaf;
                }
            });
            for (const uint32_t i : batch)
                if (next[i] != kNone)
                    queues.push(next[i], i);
        }
    }
    (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += count;
    statistics_.invalid_rays += invalid;
    statistics_.flagged += flagged;
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
