// SPDX-License-Identifier: Apache-2.0
// PassRunner: calls the tracer on the thread of its context, and runs passes beside the caller's
// own work.
#include "plugin/two_level/pass_runner.h"

#include "core/system/stopwatch.h"
#include "core/text/format_text.h"
#include "plugin/build/build_scene.h"
#include "plugin/leaf_store/leaf_store.h"
#include "plugin/two_level/tracer_trials.h"
#include "plugin/two_level/waiting.h"

#include <cassert>
#include <utility>

namespace ovc {

/// The min bytes of a pool for pages that grow or come in updates.
constexpr uint64_t kMinSpare = 64 << 10;

/// Returns the plan with a pool of the bytes that the scene leaves or needs.
static MemoryPlan plan_for(const Tracing& tracing, MemoryPlan plan) {
    const BuiltScene& scene = tracing.scene;
    if (scene.pages.empty())
        return plan;
    plan.active_bytes = tracing.options.tell_active ? scene.pages.size() * sizeof(uint32_t) : 0;
    plan.pool_bytes = room_for_pool(scene, tracing.options, plan);
    const Fit fit = fit_in(bytes_of_each(scene.pages), plan.pool(), scene.top.room());
    if (fit.pages < scene.pages.size())
        return plan;
    const uint64_t spare = scene.expects_updates() ? fit.pool_bytes / 16 + kMinSpare : 0;
    plan.pool_bytes = std::min(plan.pool_bytes, fit.pool_bytes + spare);
    return plan;
}

/// Returns the bytes that the plan's buffers take.
static uint64_t bytes_of(const BuiltScene& scene, const MemoryPlan& plan) {
    return plan.ray_bytes() + plan.pool_bytes + plan.active_bytes + scene.top.table_bytes();
}

PassRunner::PassRunner(const Tracing& tracing, GlThread& gl, const MemoryPlan& plan, LogSink log)
    : tracing_(tracing), gl_(gl), log_(std::move(log)), share_(gl.budget(), [this] { close(); }) {
    set_plan(plan_for(tracing, plan));
}

/// Returns the plan for a share of so many bytes, less than what the scene has use for.
MemoryPlan PassRunner::plan_within(uint64_t bytes) const {
    Result<MemoryPlan> plan =
        plan_memory(bytes, gl_.info(), whole_.bytes_per_ray, tracing_.options.buffer_bytes);
    assert(plan);
    plan->driver_bytes = whole_.driver_bytes;
    return plan_for(tracing_, *plan);
}

void PassRunner::set_plan(const MemoryPlan& whole) {
    demand(whole);
    plan_ = whole;
    planned_ = share_.max_bytes();
}

/// Says to the budget what the scene, as it is now, has use for.
void PassRunner::demand(const MemoryPlan& whole) {
    const BuiltScene& scene = tracing_.scene;
    whole_ = whole;
    const uint64_t max = scene.pages.empty() ? 0 : bytes_of(scene, whole);
    uint64_t min = max;
    if (gl_.budget().bytes() > 0 && max > 0) {
        const uint64_t tables = bytes_of(scene, whole) - whole.ray_bytes() - whole.pool_bytes;
        min = smallest_budget(scene.largest_page_bytes() + scene.top.room() + tables, gl_.info());
        if (min >= max || !is_usable(scene.top, scene.pages, plan_within(min).pool()))
            min = max; // its leaves were not cut for less
    }
    share_.demand(min, max);
}

Result<SharedBudget::Use> PassRunner::begin_use(BuildProgress* progress) {
    if (tracing_.scene.pages.empty())
        return SharedBudget::Use(); // every ray misses, no GPU needed
    Result<SharedBudget::Use> use = share_.begin([&] {
        add(progress, 0); // throws where the commit is cancelled
        return tracing_.watch.keeps_on();
    });
    if (!use || (is_whole_ && tracer_ && tracer_generation_ == gl_.generation()))
        return use;
    if (const uint64_t bytes = share_.bytes(); bytes != std::exchange(planned_, bytes))
        plan_ = bytes < bytes_of(tracing_.scene, whole_) ? plan_within(bytes) : whole_;
    if (const Result<Done> opened = open(progress); !opened)
        return opened.error();
    return use;
}

/// Makes the tracer that the plan asks for. Called on the context's thread.
Result<std::unique_ptr<Tracer>> PassRunner::make_tracer(GlState& state) {
    tracer_.reset();
    tracer_generation_ = state.generation;
    if (!state.context.alive())
        return Error{"the GPU's context is lost", ErrorKind::DeviceLost};
    Result<std::unique_ptr<Tracer>> made = Tracer::create(
        plan_, {tracing_.options.certify, variants(state)}, gl_.info(), state.kernels,
        tracing_.scene.level1.bounds, tracing_.scene.pages, tracing_.scene.top);
    if (!made || tracing_.options.variant != VariantChoice::Given)
        return made;
    const KernelVariant& variant = tracing_.options.given_variant;
    if (!(*made)->can_read_as(variant))
        return Error{format_text("the device cannot read this scene's pages as the kernel variant "
                                 "'{}' does; expected another of textures, images and storage",
                                 variant.text()),
                     ErrorKind::InvalidArgument};
    if (!(*made)->can_run(variant))
        say(log_, LogLevel::Warning,
            "frames are changed in doubles: the device or the scene does not suit float-pairs");
    return made;
}

/// Makes the tracer, with a smaller pool where the driver has no room for the plan's.
Result<Done> PassRunner::open(BuildProgress* progress) {
    is_whole_ = false;
    while (true) {
        Result<std::unique_ptr<Tracer>> made = Error{};
        gl_.run([&](GlState& state) { made = make_tracer(state); });
        if (made) {
            tracer_ = std::move(*made);
            break;
        }
        if (made.error().kind == ErrorKind::DeviceLost)
            return lost();
        if (made.error().kind != ErrorKind::OutOfGpuMemory)
            return made.error();
        const BuiltScene& scene = tracing_.scene;
        const uint64_t smaller =
            std::max(plan_.pool_bytes / 2, scene.largest_page_bytes() + scene.top.room());
        if (smaller == plan_.pool_bytes ||
            !is_usable(scene.top, scene.pages, {smaller, plan_.buffer_bytes}))
            return Error{format_text("{}: it has no room for the largest page, {} bytes",
                                     made.error().message, smaller),
                         ErrorKind::OutOfGpuMemory};
        say(log_, LogLevel::Warning,
            format_text("the GPU has no room for a pool of {} bytes; going on with {}",
                        plan_.pool_bytes, smaller));
        plan_.pool_bytes = smaller;
    }
    bring_first(progress);
    gpu_bytes_ = tracer_->ledger().in_use;
    tracing_.statistics.gpu_peak_bytes =
        std::max(tracing_.statistics.gpu_peak_bytes, tracer_->ledger().peak);
    const Result<Done> fine = tracing_.watch.unless_cancelled();
    is_whole_ = bool(fine);
    return fine;
}

/// Does something that waits for work with the tracer. Work that throws, for want of memory, leaves
/// a tracer of no use: with a pass that nobody collects, or without a page that it believes it has.
template <class Waits>
void PassRunner::with_tracer(Waits&& waits) {
    try {
        waits();
    } catch (...) {
        is_whole_ = false;
        throw;
    }
}

void PassRunner::finish(GlThread::Job& job) {
    with_tracer([&] { gl_.finish(job, [this] { tracing_.watch.keeps_on(); }); });
}

/// Returns whether the pages could be brought up to date where they are. anew: the plan of the
/// scene as it is now.
Result<bool> PassRunner::update_in_place(const MemoryPlan& anew, const PageChanges& changes) {
    const BuiltScene& scene = tracing_.scene;
    const Result<SharedBudget::Use> use = share_.begin([] { return true; });
    if (!use)
        return use.error();
    bool updated = false;
    if (tracer_ && is_whole_)
        gl_.run([&](GlState& state) {
            updated = is_ours(state) && tracer_->update(scene.level1.bounds, scene.pages,
                                                        changes.was, changes.changed);
        });
    if (!updated)
        return false;
    if (!tracer_->all_fit())
        return anew.pool_bytes == whole_.pool_bytes; // pages come and go as before
    bring(tracer_->missing());
    return tracer_->all_resident(); // if not, there is no room between pages
}

Result<Done> PassRunner::update(const MemoryPlan& plan, const PageChanges& changes,
                                BuildProgress* progress) {
    const MemoryPlan anew = plan_for(tracing_, plan);
    const Result<bool> updated = update_in_place(anew, changes);
    if (!updated)
        return updated.error();
    if (*updated) {
        demand(anew);
        return Done{};
    }
    purge();
    set_plan(anew);
    const Result<SharedBudget::Use> use = begin_use(progress);
    return use ? Result<Done>(Done{}) : use.error();
}

void PassRunner::purge() {
    share_.close();
    for (Batch& batch : batches_)
        batch.clear();
}

void PassRunner::close() {
    if (tracer_)
        gl_.run([&](GlState&) { tracer_.reset(); });
    gpu_bytes_ = 0;
}

Error PassRunner::lost() {
    const Result<Done> again = gl_.reopen(tracer_generation_);
    return {format_text("the GPU's context was lost{}",
                        again ? "; the device is open again, and the next call will work"
                              : ", and the device does not open again: " + again.error().message),
            ErrorKind::DeviceLost};
}

void PassRunner::bring_first(BuildProgress* progress) {
    constexpr uint64_t kBytesAtOnce = 32 << 20; // moved between two looks whether to stop
    const std::vector<Page>& pages = tracing_.scene.pages;
    begin(progress, "moving pages to the GPU", 0.05, plan_.pool_bytes);
    const size_t fitting =
        fit_in(bytes_of_each(pages), plan_.pool(), tracing_.scene.top.room()).pages;
    if (tracing_.scene.store && fitting < pages.size())
        return; // rays say soon which of them are worth reading
    for (size_t next = 0; next < fitting;) {
        std::vector<uint32_t> some;
        uint64_t bytes = 0;
        for (; next < fitting && bytes < kBytesAtOnce; ++next) {
            some.push_back(uint32_t(next));
            bytes += pages[next].bytes();
        }
        bring(some);
        add(progress, bytes);
    }
}

/// Moves pages in as Tracer::bring() does, from wherever they lie. Called on the context's thread.
Moved PassRunner::move_in(std::span<const uint32_t> wanted) {
    const BuiltScene& scene = tracing_.scene;
    if (!scene.store)
        return tracer_->bring(wanted);
    const auto give = [&](uint32_t leaf, FunctionRef<void(std::span<const uvec4>)> take) {
        const PageCache::Pin page = scene.store->page(scene.pages[leaf].stored_number);
        if (!page.texels().empty())
            take(page.texels());
    };
    return tracer_->bring(wanted, give);
}

void PassRunner::read_ahead(std::span<const uint32_t> wanted) const {
    const BuiltScene& scene = tracing_.scene;
    if (!scene.store)
        return;
    std::vector<uint32_t> numbers;
    for (const uint32_t leaf : wanted)
        numbers.push_back(scene.pages[leaf].stored_number);
    scene.store->read_ahead(std::move(numbers));
}

std::vector<uint64_t> PassRunner::costs() const {
    const BuiltScene& scene = tracing_.scene;
    std::vector<uint64_t> costs = bytes_of_each(scene.pages);
    if (scene.store)
        for (size_t leaf = 0; leaf < costs.size(); ++leaf)
            if (!scene.store->is_here(scene.pages[leaf].stored_number))
                costs[leaf] *= kDiskByte;
    return costs;
}

size_t PassRunner::bring(std::span<const uint32_t> wanted) {
    assert(tracer_);
    Moved moved;
    with_tracer([&] {
        gl_.run([&](GlState& state) {
            if (is_ours(state))
                moved = move_in(wanted);
        });
    });
    tracing_.statistics.pages_in += moved.pages;
    tracing_.statistics.bytes_in += moved.bytes;
    return moved.pages;
}

/// Fast answers are each kernel's own, so these must not depend on what was measured.
bool PassRunner::takes_measured() const {
    const VariantChoice choice = tracing_.options.variant;
    return tracing_.options.certify &&
           (choice == VariantChoice::Measured || choice == VariantChoice::Thorough);
}

/// A software renderer compiles a kernel on this thread, which takes longer than there is time for
/// all, so it is measured by those alone who ask for it.
bool PassRunner::measures() const {
    return takes_measured() &&
           (tracing_.options.variant == VariantChoice::Thorough || !gl_.info().is_software);
}

/// Returns the variants for the passes to come.
ChosenVariants PassRunner::variants(GlState& state) const {
    if (tracing_.options.variant == VariantChoice::Given)
        return ChosenVariants(tracing_.options.given_variant);
    if (takes_measured()) {
        if (!state.tuning)
            state.tuning = DeviceTuning::of(gl_.info(), log_);
        return state.tuning->variants();
    }
    return default_variants(gl_.info(), tracing_.options.compute);
}

/// Measures variants with the first of the rays that a pass has traced.
void PassRunner::tune(GlState& state, SentRays& rays, const PassCost& pass) {
    const bool thorough = tracing_.options.variant == VariantChoice::Thorough;
    const TuningLimits limits = thorough ? TuningLimits::thorough() : TuningLimits{};
    const double rate = double(rays.size()) / std::max(pass.kernel_seconds, 1e-9);
    const size_t some = std::clamp<size_t>(size_t(limits.trial_seconds * rate),
                                           std::min<size_t>(32768, rays.size()), rays.size());
    rays.unpart();
    const RayKind kind = tracer_->ray_kind();
    TracerTrials trials(*tracer_, rays.first(some), log_);
    state.tuning->after_pass(kind, pass, limits, trials);
}

void PassRunner::begin_pass(Batch& batch, std::span<const uint32_t> wanted) {
    assert(tracer_ && !batch.rays.empty() && batch.rays.size() <= plan_.batch_rays);
    assert(batch.sent.size() == batch.rays.size() && batch.stage == Batch::Stage::None);
    batch.result = {};
    batch.pass = {};
    std::function<void(GlState&)> work =
        [this, &batch, pages = std::vector(wanted.begin(), wanted.end())](GlState& state) {
            send(state, batch, pages);
        };
    sent_.push_back(&batch); // nothing behind this takes memory
    batch.stage = Batch::Stage::Sent;
    gl_.begin(batch.sending, std::move(work));
    // The device always has something to do: a pass is collected once the next one is sent.
    while (sent_.size() >= passes_in_flight())
        begin_to_collect();
}

/// Begins to collect the first pass that was sent.
void PassRunner::begin_to_collect() {
    Batch& batch = *sent_.front();
    sent_.pop_front();
    batch.stage = Batch::Stage::Collected;
    gl_.begin(batch.collecting, [this, &batch](GlState& state) { collect(state, batch); });
}

/// Sends the pass. Called on the context's thread.
void PassRunner::send(GlState& state, Batch& batch, std::span<const uint32_t> wanted) {
    if (!is_ours(state))
        return;
    const Stopwatch watch;
    tracer_->use(variants(state));
    const Result<Tracer::Pass> pass = tracer_->submit(batch.sent);
    if (pass)
        batch.pass = *pass;
    else
        batch.result.done = pass.error();
    if (pass)
        batch.result.moved = move_in(wanted);
    batch.result.seconds = watch.seconds();
}

/// Collects the answers of the pass. Called on the context's thread.
void PassRunner::collect(GlState& state, Batch& batch) {
    PassResult& result = batch.result;
    if (!is_ours(state))
        return;
    const Stopwatch watch;
    if (batch.pass)
        result.done = tracer_->collect(*batch.pass, batch.answers);
    result.alive = state.context.alive(); // a dead context leaves anything in the answers
    result.seconds += watch.seconds();
    result.kernel_seconds = tracer_->kernel_seconds();
    if (result.alive && result.done && measures() && !tracer_->are_passes_under_way())
        tune(state, batch.sent, {batch.rays.size(), result.kernel_seconds, result.seconds});
}

size_t PassRunner::moved_beside(Batch& batch) {
    finish(batch.sending);
    return size_t(batch.result.moved.pages);
}

Result<Done> PassRunner::finish_pass(Batch& batch) {
    if (batch.stage == Batch::Stage::Sent)
        begin_to_collect();
    assert(batch.stage == Batch::Stage::Collected);
    finish(batch.collecting); // after the other
    finish(batch.sending);
    batch.stage = Batch::Stage::None;
    const auto& [done, alive, moved, seconds, kernel_seconds] = batch.result;
    if (!alive)
        return lost();
    if (!done) {
        is_whole_ = false;
        return done.error();
    }
    const size_t count = batch.rays.size();
    ovc_statistics& statistics = tracing_.statistics;
    statistics.passes += 1;
    statistics.ray_visits += count;
    statistics.seconds_pass += seconds;
    seconds_a_ray_ = seconds / double(count);
    statistics.seconds_kernel += kernel_seconds;
    statistics.pages_in += moved.pages;
    statistics.bytes_in += moved.bytes;
    return Done{};
}

void PassRunner::abandon() {
    while (!sent_.empty())
        begin_to_collect();
    for (Batch& batch : batches_)
        if (std::exchange(batch.stage, Batch::Stage::None) != Batch::Stage::None)
            for (GlThread::Job* const job : {&batch.sending, &batch.collecting})
                try {
                    finish(*job);
                } catch (...) { // the call has failed already
                }
}

std::vector<uint32_t> PassRunner::take_active() {
    std::vector<uint32_t> active(tracing_.scene.pages.size());
    gl_.run([&](GlState& state) {
        if (tracer_ && is_ours(state))
            active = tracer_->take_active();
    });
    return active;
}

size_t PassRunner::part_rays(size_t rays) const {
    // A large GPU runs a quarter of a million invocations at once.
    const size_t max = size_t(1) << (gl_.info().is_software ? 17 : 18);
    constexpr size_t kMin = size_t(1) << 15, kMinWatched = 1024;
    constexpr double kSeconds = 0.03;
    const size_t part = std::min<size_t>(std::clamp(rays / 4, kMin, max), plan_.batch_rays);
    if (!tracing_.watch.is_watched())
        return part;
    // Somebody may cancel the call, so a pass takes some hundredths of a second, as far as the pass
    // before tells.
    const double fitting = kSeconds / std::max(seconds_a_ray_, 1e-9);
    return std::min(part, std::max(kMinWatched, size_t(fitting)));
}

} // namespace ovc
