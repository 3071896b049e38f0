// SPDX-License-Identifier: Apache-2.0
// Comparison: building, and batches of rays into the scene's frame, through the kernel and back.
#include "plugin/thesis/comparison.h"

#include "core/parallel.h"
#include "core/stopwatch.h"
#include "gpu/page_walk.h"
#include "plugin/thesis/hittable.h"
#include "shaders/layout.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>

namespace ovc::thesis {
namespace {

constexpr size_t kGrain = 256; // rays a task

} // namespace

Result<std::unique_ptr<Structure>> Comparison::build(const Soup& soup, GlThread& gl,
                                                     const RunnerOptions& options,
                                                     const LogSink& log, BuildProgress* progress) {
    begin(progress, "triangles", 0.05, 2 * soup.triangle_count());
    std::unique_ptr<Comparison> self(new Comparison(soup, gl, options));
    ovc_statistics& statistics = self->statistics_;
    statistics.gpu_budget_bytes = options.budget_bytes;
    Hittable hittable = take_hittable(soup, statistics, log, progress);
    self->twins_ = std::move(hittable.twins);
    const std::vector<TriangleId>& triangles = hittable.triangles;
    if (!triangles.empty())
        if (const Result<Done> built = self->build_system(triangles, hittable.bounds, progress);
            !built)
            return built.error();
    return std::unique_ptr<Structure>(std::move(self));
}

Result<Done> Comparison::build_system(const std::vector<TriangleId>& triangles, const Box& bounds,
                                      BuildProgress* progress) {
    begin(progress, thesis::name_of(options_.structure), 0.9,
          work_of(options_.structure, triangles.size()));
    const Stopwatch watch;
    whole_ = whole_leaf(soup_, triangles, bounds);
    // What cannot fit is not built.
    const uint64_t least = least_bytes(options_.structure, triangles.size()) / sizeof(uvec4);
    if (const Result<MemoryPlan> plan = plan_memory(options_, least, "at least "); !plan)
        return plan.error();
    Result<System> system = thesis::build_system(options_.structure, soup_, whole_, progress);
    if (!system)
        return system.error();
    const Result<MemoryPlan> plan = plan_memory(options_, system->texels.size());
    if (!plan)
        return plan.error();
    batch_rays_ = plan->batch_rays();
    statistics_.leaves = plan->tiles.count();
    statistics_.leaf_references = system->references;
    statistics_.level2_bytes = system->texels.size() * sizeof(uvec4);
    statistics_.largest_page_bytes = plan->tiles.tile_bytes(0);
    statistics_.pages_in = plan->tiles.count();
    statistics_.bytes_in = plan->tiles.bytes();
    statistics_.seconds_level2 = watch.seconds();
    begin(progress, "moving it to the GPU", 0.05, 1);
    Result<std::unique_ptr<Runner>> runner = Error{};
    gl_.run([&](GlState&) {
        runner = Runner::create(options_, *plan, std::move(*system), gl_.info().is_software);
    });
    if (!runner)
        return runner.error();
    runner_ = std::move(*runner);
    statistics_.gpu_peak_bytes = runner_->ledger().peak;
    return Done{};
}

Comparison::~Comparison() {
    gl_.run([&](GlState&) { runner_.reset(); });
}

/// Rays [first, first + count) of a call.
template <class Query>
class Comparison::Batch {
public:
    Batch(Comparison& comparison, const Query& query, size_t first, size_t count)
        : c_(comparison),
          query_(query),
          first_(first),
          count_(count),
          rays_(Runner::row_padded(count)),
          answers_(rays_.size()),
          decidable_(count),
          retrace_(count) {}

    Result<Done> run() {
        each_ray([&](size_t i) { enter(i); });
        if (c_.runner_) {
            const Stopwatch watch;
            Result<uint64_t> passes = Error{};
            c_.gl_.run(
                [&](GlState&) { passes = c_.runner_->trace(Query::kAnyHit, rays_, answers_); });
            if (!passes)
                return passes.error();
            c_.statistics_.passes += *passes;
            c_.statistics_.seconds_pass += watch.seconds();
            c_.statistics_.seconds_kernel = c_.statistics_.seconds_pass;
            c_.statistics_.ray_visits += count_;
            each_ray([&](size_t i) { settle(i); });
            if (retraced_ > 0)
                retrace();
        }
        c_.statistics_.invalid_rays += invalid_;
        c_.statistics_.flagged += flagged_;
        c_.statistics_.retraced += retraced_;
        c_.statistics_.capped += capped_;
        return Done{};
    }

private:
    template <class Body>
    void each_ray(Body&& body) {
        parallel_for(count_, kGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i)
                body(i);
        });
    }

    /// Makes the ray a miss until more is known, and takes it into the frame.
    void enter(size_t i) {
        query_.set_miss(first_ + i);
        decidable_[i] = true;
        if (!query_.rays[first_ + i].valid()) {
            ++invalid_;
            return;
        }
        bool decidable = true;
        PreparedRay p = prepare(query_, first_ + i);
        if (c_.twins_.stands_for_others(p.skip))
            p.skip = {}; // the others are to be found
        if (c_.runner_)
            rays_[i] = frame_ray(c_.whole_, p, decidable);
        decidable_[i] = decidable;
    }

    void settle(size_t i) {
        const FrameAnswer& answer = answers_[i];
        if (decidable_[i] && rays_[i].t_end < 0)
            return; // invalid, or past the scene
        const PreparedRay p = prepare(query_, first_ + i);
        capped_ += decidable_[i] && answer.prim == OVC_CAPPED;
        const bool named = decidable_[i] && answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
        if (!named || !take_in(i, p, answer)) {
            retrace_[i] = true;
            ++retraced_;
        }
    }

    /// False when double does not find what the kernel was certain of.
    bool take_in(size_t i, const PreparedRay& p, const FrameAnswer& answer) {
        if (!c_.options_.certify) {
            if (answer.prim != OVC_MISS)
                query_.set(first_ + i, fast_hit(p, answer));
            return true;
        }
        const bool has_rivals = answer.rivals()[0] != OVC_NO_TRIANGLE;
        if (Query::kAnyHit && !has_rivals && answer.prim != OVC_MISS) {
            query_.set(first_ + i, Hit{0, 0, 0, c_.whole_.triangles[answer.prim]});
            return true;
        }
        Nearest nearest(p);
        if (answer.prim != OVC_MISS && !offer(nearest, answer.prim, p.skip))
            return false;
        for (const uint32_t rival : answer.rivals())
            if (rival != OVC_NO_TRIANGLE)
                offer(nearest, rival, p.skip);
        query_.set(first_ + i, nearest);
        flagged_ += has_rivals; // retrace() counts the others
        return true;
    }

    Hit fast_hit(const PreparedRay& p, const FrameAnswer& answer) const {
        const Hit hit{world_t(c_.whole_, p, answer.t()), answer.u(), answer.v(),
                      c_.whole_.triangles[answer.prim]};
        return c_.twins_.seen(c_.soup_, hit, p.skip);
    }

    bool offer(Nearest& nearest, uint32_t index, TriangleId skip) const {
        const TriangleId id = c_.twins_.seen(c_.whole_.triangles[index], skip);
        return nearest.offer(c_.soup_.triangle(id), id);
    }

    /// Builds the arbiter's page the first time; not within the loop over rays, whose threads would
    /// wait for it.
    void retrace() {
        if (c_.arbiter_.texels.empty())
            c_.arbiter_ = build_page(c_.soup_, c_.whole_);
        each_ray([&](size_t i) {
            if (retrace_[i])
                decide_in_double(i);
        });
        flagged_ += retraced_;
    }

    /// As the product's arbiter does in each leaf (plugin/arbiter.h).
    void decide_in_double(size_t i) {
        const PreparedRay p = prepare(query_, first_ + i);
        Nearest nearest(p);
        const auto test = [&](uint32_t index) {
            return offer(nearest, index, p.skip) && Query::kAnyHit;
        };
        walk_page(c_.arbiter_, c_.whole_, p, p.ray.t_min, test, [&] { return nearest.limit(); });
        query_.set(first_ + i, nearest);
    }

    Comparison& c_;
    const Query& query_;
    const size_t first_;
    const size_t count_;
    std::vector<FrameRay> rays_; // whole rows, the last one filled up with no rays
    std::vector<FrameAnswer> answers_;
    std::vector<uint8_t> decidable_;
    std::vector<uint8_t> retrace_;
    std::atomic<uint64_t> invalid_{0};
    std::atomic<uint64_t> flagged_{0};
    std::atomic<uint64_t> retraced_{0};
    std::atomic<uint64_t> capped_{0};
};

template <class Query>
Result<Done> Comparison::trace(const Query& query) {
    const Stopwatch watch;
    const size_t most = runner_ ? batch_rays_ : std::max<size_t>(query.rays.size(), 1);
    for (size_t first = 0; first < query.rays.size(); first += most) {
        const size_t count = std::min(most, query.rays.size() - first);
        if (Result<Done> done = Batch<Query>(*this, query, first, count).run(); !done)
            return done;
        (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += count;
    }
    statistics_.seconds_trace += watch.seconds();
    return Done{};
}

Result<Done> Comparison::intersect(RaySpan rays, std::span<const TriangleId> skip,
                                   std::span<Hit> hits) {
    return trace(NearestQuery{rays, skip, hits});
}

Result<Done> Comparison::occluded(RaySpan rays, std::span<const TriangleId> skip,
                                  std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, skip, occluded});
}

} // namespace ovc::thesis
