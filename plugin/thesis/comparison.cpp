// SPDX-License-Identifier: Apache-2.0
// Comparison: builds a system, and takes batches of rays into the scene's frame, through the kernel
// and back.
#include "plugin/thesis/comparison.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/resolve/candidates.h"
#include "plugin/thesis/queued/hittable.h"
#include "shaders/layout.h"

#include <algorithm>
#include <atomic>
#include <cassert>

namespace ovc::thesis {
namespace {

constexpr size_t kRayGrain = 256; // rays per task

} // namespace

Result<std::unique_ptr<Structure>> Comparison::build(const Soup& soup, GlThread& gl,
                                                     const RunnerOptions& options,
                                                     const LogSink& log, BuildProgress* progress) {
    begin(progress, "triangles", 0.05, 2 * soup.triangle_count());
    std::unique_ptr<Comparison> self(new Comparison(soup, gl, options));
    ovc_statistics& statistics = self->statistics_;
    statistics.gpu_budget_bytes = options.budget_bytes;
    const Hittable hittable = take_hittable(self->scene_, statistics, log, progress);
    if (!hittable.triangles.empty())
        if (const Result<Done> built = self->build_system(hittable, progress); !built)
            return built.error();
    return std::unique_ptr<Structure>(std::move(self));
}

Result<Done> Comparison::build_system(const Hittable& hittable, BuildProgress* progress) {
    const auto& [triangles, bounds] = hittable;
    begin(progress, thesis::name_of(options_.structure), 0.9,
          work_of(options_.structure, triangles.size()));
    const Stopwatch watch;
    scene_.level1.nodes = {KdNode::leaf(0, 1)};
    scene_.level1.bounds = bounds;
    scene_.level1.leaves = {whole_leaf(scene_.soup, triangles, bounds)};
    // A system that cannot fit is not built.
    const uint64_t min_texels = min_bytes(options_.structure, triangles.size()) / sizeof(uvec4);
    if (const Result<MemoryPlan> plan = plan_memory(options_, min_texels, "at least "); !plan)
        return plan.error();
    Result<System> system =
        thesis::build_system(options_.structure, scene_.soup, whole(), progress);
    if (!system)
        return system.error();
    const Result<MemoryPlan> plan = plan_memory(options_, system->texels.size());
    if (!plan)
        return plan.error();
    assert(plan->tiles.count() > 0);
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
            each_ray([&](size_t i) { resolve(i); });
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
        parallel_for(count_, kRayGrain, [&](size_t from, size_t to) {
            for (size_t i = from; i < to; ++i)
                body(i);
        });
    }

    PreparedRay prepared(size_t i) const {
        return PreparedRay(query_.rays[first_ + i], query_.without[first_ + i]);
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
        PreparedRay p = prepared(i);
        if (c_.scene_.stands_for_others(p.skip))
            p.skip = {}; // because its duplicates can be hit
        if (c_.runner_)
            rays_[i] = frame_ray(c_.whole(), p, decidable);
        decidable_[i] = decidable;
    }

    void resolve(size_t i) {
        const FrameAnswer& answer = answers_[i];
        if (decidable_[i] && rays_[i].t_end < 0)
            return; // invalid, or past the scene
        const PreparedRay p = prepared(i);
        capped_ += decidable_[i] && answer.prim == OVC_CAPPED;
        const bool named = decidable_[i] && answer.prim != OVC_FLAGGED && answer.prim != OVC_CAPPED;
        if (!named || !resolve_candidates(i, p, answer)) {
            retrace_[i] = true;
            ++retraced_;
        }
    }

    /// Returns false where exact arithmetic does not confirm the certain hit.
    bool resolve_candidates(size_t i, const PreparedRay& p, const FrameAnswer& answer) {
        if (!c_.options_.certify) {
            if (answer.prim != OVC_MISS)
                query_.set(first_ + i, fast_hit(p, answer));
            return true;
        }
        const std::array further{number(answer.further()[0]), number(answer.further()[1])};
        const Candidates found{number(answer.prim), further};
        if (found.is_miss())
            return true;
        if (Query::kAnyHit && found.is_certain_hit()) {
            query_.set(first_ + i, Hit{0, 0, 0, c_.scene_.numbers.id(found.certain)});
            return true;
        }
        Nearest nearest(p);
        if (!found.offer_to(nearest, p, c_.scene_))
            return false;
        query_.set(first_ + i, nearest);
        flagged_ += found.has_further(); // retrace() counts the others
        return true;
    }

    /// Returns a candidate's number; the kernels of the thesis name it by its index in the leaf.
    uint32_t number(uint32_t index) const {
        return index < c_.whole().triangles.size()
                   ? c_.scene_.numbers.of(c_.whole().triangles[index])
                   : index; // OVC_MISS, OVC_NO_TRIANGLE
    }

    Hit fast_hit(const PreparedRay& p, const FrameAnswer& answer) const {
        const Hit hit{world_t(c_.whole(), p, answer.t()), answer.u(), answer.v(),
                      c_.whole().triangles[answer.prim]};
        return c_.scene_.seen(hit, p.skip);
    }

    /// Traces the rays again that are left. The first call builds the page, outside the loop over
    /// rays, whose threads would wait for it.
    void retrace() {
        BuiltScene& scene = c_.scene_;
        if (scene.pages.empty()) {
            scene.pages.push_back(build_page(scene.soup, scene.numbers, c_.whole()));
            scene.top = build_top_level(scene.pages, 1);
        }
        each_ray([&](size_t i) {
            if (retrace_[i])
                query_.set(first_ + i, trace_exactly<Query::kAnyHit>(scene, prepared(i)));
        });
        flagged_ += retraced_;
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
    assert(!runner_ || batch_rays_ > 0);
    const size_t max_rays = runner_ ? batch_rays_ : std::max<size_t>(query.rays.size(), 1);
    for (size_t first = 0; first < query.rays.size(); first += max_rays) {
        const size_t count = std::min(max_rays, query.rays.size() - first);
        if (Result<Done> done = Batch<Query>(*this, query, first, count).run(); !done)
            return done;
        (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += count;
    }
    statistics_.seconds_trace += watch.seconds();
    return Done{};
}

Result<Done> Comparison::intersect(RaySpan rays, const Exclusions& without, std::span<Hit> hits) {
    return trace(NearestQuery{rays, without, hits});
}

Result<Done> Comparison::occluded(RaySpan rays, const Exclusions& without,
                                  std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, without, occluded});
}

} // namespace ovc::thesis
