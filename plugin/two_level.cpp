// SPDX-License-Identifier: Apache-2.0
// Two-level: building, and the loop over passes.
#include "plugin/two_level.h"

#include "core/stopwatch.h"
#include "gpu/linked.h"
#include "plugin/one_pass.h"
#include "plugin/saved_levels.h"
#include "plugin/wave.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace ovc {
namespace {

constexpr size_t kWaveRays = 4u << 20; // rays in flight: bounds the host memory of a call
} // namespace

Result<std::unique_ptr<TwoLevel>> TwoLevel::build(const Soup& soup, GlThread& gl,
                                                  const TwoLevelOptions& options,
                                                  const LogSink& log, BuildProgress* progress) {
    Result<MemoryPlan> plan = plan_memory(budget_of(options, gl.info()), gl.info());
    if (!plan)
        return plan.error();
    plan->driver_bytes = options.driver_bytes;
    if (const Result<Done> fine = check_count(soup); !fine)
        return fine.error();
    if (const Result<Done> enough = check_budget(soup, options, *plan, gl.info()); !enough)
        return enough.error();
    Result<BuiltScene> scene = build_scene(soup, options, *plan, log, progress);
    if (!scene)
        return scene.error();
    std::unique_ptr<TwoLevel> self(new TwoLevel(std::move(*scene), gl, options, *plan, log));
    if (self->scene_.pages.empty())
        return self; // every ray misses, no GPU needed
    self->share_out();

    const Result<Done> made = self->make_tracer(progress);
    if (made)
        return self;
    if (made.error().kind != ErrorKind::OutOfGpuMemory || self->scene_.pages.size() > 1 ||
        options.leaf_triangles || options.leaves)
        return made.error();
    say(log, LogLevel::Warning, "cutting the scene into leaves, of which the GPU holds some");
    TwoLevelOptions cut = options;
    cut.leaf_triangles = self->scene_.limits.triangles;
    self.reset();
    return build(soup, gl, cut, log, progress);
}

Result<Done> TwoLevel::save(const ByteSink& sink) const {
    if (!save_levels(scene_, sink))
        return Error{"saving was stopped", ErrorKind::Cancelled};
    return Done{};
}

/// The pool and what rays need, in the context there is now; smaller where the driver has no room.
Result<Done> TwoLevel::make_tracer(BuildProgress* progress) {
    while (true) {
        Result<std::unique_ptr<Tracer>> made = Error{};
        gl_.run([&](GlState& state) {
            tracer_.reset();
            tracer_generation_ = state.generation;
            if (state.context.alive())
                made = Tracer::create(plan_, {options_.certify, options_.compute}, gl_.info(),
                                      state.kernels, scene_.level1, scene_.pages);
            else
                made = Error{"the GPU's context is lost", ErrorKind::DeviceLost};
        });
        if (made) {
            tracer_ = std::move(*made);
            break;
        }
        if (made.error().kind == ErrorKind::DeviceLost)
            return lost();
        if (made.error().kind != ErrorKind::OutOfGpuMemory)
            return made.error();
        const uint64_t smaller = std::max(plan_.pool_bytes / 2, scene_.largest_page_bytes());
        if (smaller == plan_.pool_bytes)
            return Error{fmt::format("{}: it has no room for the largest page, {} bytes",
                                     made.error().message, smaller),
                         ErrorKind::OutOfGpuMemory};
        say(log_, LogLevel::Warning,
            fmt::format("the GPU has no room for a pool of {} bytes; going on with {}",
                        plan_.pool_bytes, smaller));
        plan_.pool_bytes = smaller;
    }
    bring_first(progress);
    statistics_.peak_bytes = std::max(statistics_.peak_bytes, tracer_->ledger().peak);
    return Done{};
}

/// Makes anew what went with an earlier context, or with purge().
Result<Done> TwoLevel::ready_device() {
    if (scene_.pages.empty() || (tracer_ && tracer_generation_ == gl_.generation()))
        return Done{};
    return make_tracer(nullptr);
}

Result<Done> TwoLevel::purge() {
    if (tracer_)
        gl_.run([&](GlState&) { tracer_.reset(); });
    batches_ = {};
    return Done{};
}

/// The context is dead: a new one for the calls to come.
Error TwoLevel::lost() {
    const Result<Done> again = gl_.reopen(tracer_generation_);
    return {fmt::format("the GPU's context was lost{}",
                        again ? "; the device is open again, and the next call will work"
                              : ", and the device does not open again: " + again.error().message),
            ErrorKind::DeviceLost};
}

/// Moves in the first pages, as many as fit, so that rays need not come and wait first.
void TwoLevel::bring_first(BuildProgress* progress) {
    constexpr uint64_t kBytesAtOnce = 32 << 20; // between two looks whether to stop
    begin(progress, "moving pages to the GPU", 0.05, plan_.pool_bytes);
    uint64_t room = plan_.pool_bytes;
    for (size_t next = 0; next < scene_.pages.size() && scene_.pages[next].bytes() <= room;) {
        std::vector<uint32_t> some;
        uint64_t bytes = 0;
        for (; next < scene_.pages.size() && scene_.pages[next].bytes() <= room &&
               bytes < kBytesAtOnce;
             ++next) {
            some.push_back(uint32_t(next));
            bytes += scene_.pages[next].bytes();
            room -= scene_.pages[next].bytes();
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
void TwoLevel::share_out() {
    plan_.active_bytes = options_.tell_active ? scene_.pages.size() * sizeof(uint32_t) : 0;
    plan_.pool_bytes = std::min(plan_.pool_bytes - table_bytes(scene_, options_),
                                most_linked_bytes(scene_.level2_bytes(), scene_.pages.size()));
}

/// Moves the first pages of `wanted` in, as many as fit; returns how many.
size_t TwoLevel::bring(std::span<const uint32_t> wanted) {
    Moved moved;
    gl_.run([&](GlState& state) {
        if (is_ours(state))
            moved = tracer_->bring(wanted);
    });
    statistics_.pages_in += moved.pages;
    statistics_.bytes_in += moved.bytes;
    return moved.pages;
}

/// The rays of the batch on their way; their answers into it. Beside them, pages of `wanted` are
/// moved in; returns how many.
Result<size_t> TwoLevel::pass(Batch& batch, std::span<const uint32_t> wanted,
                              const std::function<void()>& meanwhile) {
    const size_t count = batch.rays.size();
    const Traveller none{{dvec3(0), 0, dvec3(0, 0, 1), -1}, 0, OVC_NO_TRIANGLE, OVC_NO_LEAF};
    std::fill_n(batch.travellers.begin() + ptrdiff_t(count), whole_blocks(count) - count, none);
    Result<Done> done = Done{};
    bool alive = false;
    Moved moved;
    double seconds = 0;
    const auto work = [&](GlState& state) {
        const Stopwatch watch;
        alive = is_ours(state);
        if (!alive)
            return;
        done = tracer_->submit(std::span(batch.travellers).first(count));
        if (done)
            moved = tracer_->bring(wanted);
        if (done)
            done = tracer_->collect(std::span(batch.answers).first(count));
        alive = state.context.alive(); // else what was read is anything
        seconds = watch.seconds();
    };
    gl_.run_beside(work, meanwhile, [this] { keeps_on(); });
    if (!alive)
        return lost();
    if (!done)
        return done.error();
    statistics_.passes += 1;
    statistics_.ray_visits += count;
    statistics_.seconds_pass += seconds;
    seconds_a_ray_ = seconds / double(count);
    statistics_.seconds_kernel += tracer_->kernel_seconds();
    statistics_.pages_in += moved.pages;
    statistics_.bytes_in += moved.bytes;
    return size_t(moved.pages);
}

template <class Query>
Result<Done> TwoLevel::trace(const Query& query) {
    const Stopwatch watch;
    if (Result<Done> ready = ready_device(); !ready)
        return ready;
    const bool linked = tracer_ && tracer_->all_linked();
    const Result<Done> done = linked ? trace_in_one_pass(query) : trace_in_waves(query);
    if (!done)
        return done;
    (Query::kAnyHit ? statistics_.occlusion_rays : statistics_.nearest_rays) += query.rays.size();
    statistics_.seconds_trace += watch.seconds();
    return unless_cancelled();
}

template <class Query>
Result<Done> TwoLevel::trace_in_waves(const Query& query) {
    for (size_t first = 0; first < query.rays.size(); first += kWaveRays) {
        const size_t count = std::min(kWaveRays, query.rays.size() - first);
        Wave<Query> wave(*this, query.part(first, count));
        std::vector<uint32_t> all(count);
        std::iota(all.begin(), all.end(), 0u);
        wave.start(all);
        while (wave.left() > 0) {
            Result<Done> asked = Done{};
            const auto ask = [&] {
                asked = go_on(first + count - wave.left(), query.rays.size());
                return bool(asked);
            };
            if (Result<Done> done = round(~size_t(0), ask, wave); !done)
                return done;
            if (!asked)
                return asked;
        }
    }
    return Done{};
}

/// Two batches take turns: one is with the kernel, the other is settled and filled again.
template <class Query>
Result<Done> TwoLevel::trace_in_one_pass(const Query& query) {
    OnePass<Query> rays(*this, query);
    Batch* now = &batches_[0];
    Batch* other = &batches_[1];
    other->rays.clear();
    rays.begin(*now);
    size_t traced = 0;
    while (!now->rays.empty()) {
        if (Result<Done> asked = go_on(traced, query.rays.size()); !asked)
            return asked;
        const size_t begun = rays.begun();
        const Result<size_t> moved = pass(*now, {}, [&] {
            rays.settle(*other);
            rays.begin(*other);
        });
        if (!moved)
            return moved.error();
        traced = begun;
        std::swap(now, other);
    }
    rays.settle(*other);
    return Done{};
}

Result<ovc_active> TwoLevel::take_active() {
    if (!options_.tell_active)
        return Error{"which pages are active is told where ovc_scene_config.tell_active is 1"};
    if (Result<Done> ready = ready_device(); !ready)
        return ready.error();
    std::vector<uint32_t> now(scene_.pages.size());
    gl_.run([&](GlState& state) {
        if (tracer_ && is_ours(state))
            now = tracer_->take_active();
    });
    ovc_active active{};
    was_active_.resize(scene_.pages.size());
    for (size_t leaf = 0; leaf < now.size(); ++leaf) {
        if (now[leaf]) {
            active.pages += 1;
            active.bytes += scene_.pages[leaf].bytes();
            active.new_pages += !was_active_[leaf];
            active.new_bytes += was_active_[leaf] ? 0 : scene_.pages[leaf].bytes();
        }
        was_active_[leaf] = now[leaf] != 0;
    }
    return active;
}

Result<Done> TwoLevel::intersect(RaySpan rays, std::span<const TriangleId> skip,
                                 std::span<Hit> hits) {
    return trace(NearestQuery{rays, skip, hits, {}, {}});
}

Result<Done> TwoLevel::intersect_noted(RaySpan rays, std::span<const TriangleId> skip,
                                       std::span<Hit> hits, const RayNotes& notes) {
    std::fill(notes.passes.begin(), notes.passes.end(), 0);
    std::fill(notes.flagged.begin(), notes.flagged.end(), 0);
    if (Result<Done> done = trace(NearestQuery{rays, skip, hits, notes.passes, notes.flagged});
        !done)
        return done;
    parallel_for(notes.leaf.size(), 1024, [&](size_t first, size_t last) {
        for (size_t i = first; i < last; ++i)
            notes.leaf[i] = hits[i].is_hit()
                                ? leaf_at(scene_.level1, rays[i].at(hits[i].t), hits[i].id)
                                : kNone;
    });
    return Done{};
}

Hit TwoLevel::nearest_on_cpu(const Ray& ray, TriangleId skip) const {
    return on_cpu</* kAnyHit= */ false>(ray, skip);
}

bool TwoLevel::occluded_on_cpu(const Ray& ray, TriangleId skip) const {
    return on_cpu</* kAnyHit= */ true>(ray, skip).is_hit();
}

template <bool kAnyHit>
Hit TwoLevel::on_cpu(const Ray& ray, TriangleId skip) const {
    return trace_exactly<kAnyHit>(scene_, PreparedRay(ray, skip));
}

Result<Done> TwoLevel::occluded(RaySpan rays, std::span<const TriangleId> skip,
                                std::span<uint8_t> occluded) {
    return trace(OcclusionQuery{rays, skip, occluded});
}

} // namespace ovc
