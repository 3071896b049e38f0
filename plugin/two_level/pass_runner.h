// SPDX-License-Identifier: Apache-2.0
// PassRunner: the part of a scene that lives on the device. It owns the tracer, moves pages into
// the pool and runs passes of the kernel, within the scene's share of the device's budget.
#pragma once

#include "core/system/log.h"
#include "gpu/gl/gl_thread.h"
#include "gpu/trace/tracer.h"
#include "gpu/tuning/device_tuning.h"
#include "plugin/build/update_scene.h"
#include "plugin/two_level/tracing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace ovc {

/// The rays of a pass, and their answers.
struct Batch {
    std::vector<uint32_t> rays;       // their numbers in the query
    std::array<size_t, 3> of_waves{}; // the rays of each wave, which lie together
    size_t begun = 0;                 // rays of the query that have begun with these or before
    SentRays sent;                    // the same rays
    std::vector<Answer> answers;      // at least one per ray

    /// Makes room in `sent` and `answers` for the rays.
    void make_room(const RayForm& form) {
        sent.reset(form, rays.size());
        answers.resize(std::max(rays.size(), answers.size()));
    }
};

class PassRunner {
public:
    /// plan: before portals are taken off. The thread must outlive the runner.
    PassRunner(const Tracing& tracing, GlThread& gl, const MemoryPlan& plan, LogSink log);
    PassRunner(const PassRunner&) = delete;

    /// Begins a use of the device: everything below, but for update() and purge(), is called within
    /// one. Makes the tracer where there is none, as at first, after purge(), where a context was
    /// lost and where another scene needed the memory. Its pool is smaller where the driver has no
    /// room for the plan's. Moves the first pages in, so that rays need not come and wait first.
    Result<SharedBudget::Use> begin_use(BuildProgress* progress = nullptr);
    /// Takes up the scene, which was updated so, as it is now. plan: as in the constructor.
    Result<Done> update(const MemoryPlan& plan, const PageChanges& changes,
                        BuildProgress* progress);
    /// Gives back all GPU memory.
    void purge();

    /// Whether a pass answers its rays for good, because all pages are resident.
    bool all_resident() const { return tracer_ && tracer_->all_resident(); }

    /// Moves the first pages of `wanted` in, as many as fit; returns how many.
    size_t bring(std::span<const uint32_t> wanted);

    /// Begins to read these pages, in this order, where they lie on a disk.
    void read_ahead(std::span<const uint32_t> wanted) const;
    /// Returns for each page what moving it in costs, in bytes moved from memory.
    std::vector<uint64_t> costs() const;

    /// How a pass wants its rays, within this use of the device.
    RayForm form() const { return tracer_->form(); }
    /// What a step of pass() has done.
    struct Step {
        size_t moved = 0;          // pages
        Batch* answered = nullptr; // the batch that has its answers now, if any
    };
    /// Sends the batch (at most plan().batch_rays) off in a pass, if it has any rays. Then waits
    /// for the pass that was sent first, unless there may be more under way, so that a device with
    /// several works on the next one meanwhile. Batches are answered in the order in which they
    /// were sent. Beside all that, pages of `wanted` move in behind the pass, and meanwhile() runs
    /// on this thread. Error: the context is lost, or GL's; then no pass is under way.
    Result<Step> pass(Batch& batch, std::span<const uint32_t> wanted,
                      const std::function<void()>& meanwhile);
    bool are_under_way() const { return !under_way_.empty(); }
    /// Ends all passes that are under way: those of a call that ended early.
    void forget_passes();

    /// Opens a new context for the calls to come, and returns the error for the call under way.
    Error lost();

    /// Returns for each leaf whether rays were traced through its page since the last call of this.
    std::vector<uint32_t> take_active();

    /// How many passes may be under way together. Their answers come so many steps later.
    size_t passes_in_flight() const { return plan_.passes; }
    /// Whether pages are to move in beside a pass.
    bool moves_beside() const {
        return tracing_.options.beside.value_or(gl_.info().passes_in_flight > 1);
    }
    /// Fewer rays are not worth a pass while others wait.
    size_t few_rays() const { return std::min<size_t>(4096, plan_.batch_rays / 4); }
    /// Returns how many of `rays` a pass takes, so that it keeps the device busy and leaves
    /// something to do beside it. At most plan().batch_rays.
    size_t part_rays(size_t rays) const;
    /// Returns the batch of step `step` of a call. Batches take turns and are kept between calls:
    /// while some are with the kernel, the answers of another are resolved and it is filled again.
    Batch& batch(size_t step) { return batches_[step % (passes_in_flight() + 1)]; }

    const MemoryPlan& plan() const { return plan_; }
    /// The bytes of GL buffers and textures that are alive. At any time.
    uint64_t gpu_bytes() const { return gpu_bytes_; }

private:
    void set_plan(const MemoryPlan& whole);
    void demand(const MemoryPlan& whole);
    MemoryPlan plan_within(uint64_t bytes) const;
    Result<bool> update_in_place(const MemoryPlan& anew, const PageChanges& changes);
    Result<Done> open(BuildProgress* progress);
    void close();
    void bring_first(BuildProgress* progress);
    Moved move_in(std::span<const uint32_t> wanted);
    bool takes_measured() const;
    bool measures() const;
    ChosenVariants variants(GlState& state) const;
    /// A step on the context's thread.
    struct Work;
    void work(GlState& state, Batch& batch, std::span<const uint32_t> wanted, Work& step);
    void tune(GlState& state, SentRays& rays, const PassCost& pass);
    /// Whether the tracer's context is alive. Called on the context's thread.
    bool is_ours(const GlState& state) const {
        return state.generation == tracer_generation_ && state.context.alive();
    }

    const Tracing tracing_;
    GlThread& gl_;
    const LogSink log_;
    MemoryPlan whole_; // for all that the scene has use for
    MemoryPlan plan_;  // for `planned_` bytes
    uint64_t planned_ = 0;
    std::unique_ptr<Tracer> tracer_; // made and destroyed on the thread of gl_
    std::atomic<uint64_t> gpu_bytes_{0};
    uint32_t tracer_generation_ = 0; // of the context that it was made in
    std::array<Batch, 3> batches_;
    struct UnderWay {
        Batch* batch;
        Tracer::Pass pass;
    };
    std::deque<UnderWay> under_way_; // the pass that was sent first comes first
    double seconds_a_ray_ = 1e-5;    // of the pass before
    SharedBudget::Share share_;      // closes the tracer
};

} // namespace ovc
