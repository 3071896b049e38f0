// SPDX-License-Identifier: Apache-2.0
// PassRunner: the part of a scene that lives on the device. It owns the tracer, moves pages into
// the pool and runs passes of the kernel, within the scene's share of the device's budget.
#pragma once

#include "core/system/log.h"
#include "gpu/gl/gl_thread.h"
#include "gpu/trace/tracer.h"
#include "gpu/tuning/device_tuning.h"
#include "plugin/build/update_scene.h"
#include "plugin/resolve/tracing.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace ovc {

/// What a pass comes to.
struct PassResult {
    Result<Done> done = Done{};
    bool alive = false; // the context is
    Moved moved;        // beside the pass; there as soon as the pass is sent
    double seconds = 0, kernel_seconds = 0;
};

/// The rays of a pass, and their answers.
struct Batch {
    std::vector<uint32_t> rays;       // their numbers in the query
    std::array<size_t, 3> of_waves{}; // the rays of each wave, which lie together
    SentRays sent;                    // the same rays
    Answers answers;                  // of its pass
    // Its pass is sent to the device, and later its answers are collected.
    enum class Stage { None, Sent, Collected } stage = Stage::None; // that was begun last
    GlThread::Job sending, collecting;
    std::optional<Tracer::Pass> pass; // none where it could not be sent
    PassResult result;

    /// Gives back the memory. No pass is under way.
    void clear() {
        rays = {};
        sent = {};
        answers = {};
    }
    /// Makes room in `sent` for the rays.
    void make_room(const RayForm& form) { sent.reset(form, rays.size()); }
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
    /// Begins to trace the rays of the batch (not empty, at most plan().batch_rays) in one pass,
    /// behind those that were begun before. Beside the pass, pages of `wanted` move in.
    void begin_pass(Batch& batch, std::span<const uint32_t> wanted);
    /// Returns how many pages were moved beside the pass of a batch; waits until it is sent.
    size_t moved_beside(Batch& batch);
    /// Waits for the pass of a batch, the first of those under way, whose answers are in it then.
    /// Error: the context is lost, or GL's.
    Result<Done> finish_pass(Batch& batch);
    /// How many passes the device has under way at once.
    uint32_t passes_in_flight() const { return gl_.info().passes_in_flight; }
    /// When it goes, no pass is under way: it waits for those that a call which ends early has
    /// begun, whatever they come to.
    class Scope {
    public:
        explicit Scope(PassRunner& passes) : passes_(passes) {}
        ~Scope() { passes_.abandon(); }
        Scope(const Scope&) = delete;

    private:
        PassRunner& passes_;
    };

    /// Opens a new context for the calls to come, and returns the error for the call under way.
    Error lost();

    /// Returns for each leaf whether rays were traced through its page since the last call of this.
    std::vector<uint32_t> take_active();

    /// Whether pages are to move in beside a pass.
    bool moves_beside() const { return tracing_.options.beside.value_or(passes_in_flight() > 1); }
    /// Fewer rays are not worth a pass while others wait.
    size_t few_rays() const { return std::min<size_t>(4096, plan_.batch_rays / 4); }
    /// Returns how many of `rays` a pass takes, so that it keeps the device busy and leaves
    /// something to do beside it. At most plan().batch_rays.
    size_t part_rays(size_t rays) const;
    /// Three batches, kept between calls, take turns: one is with the kernel and one waits for it,
    /// on the device where that has several passes under way, while the answers of the third are
    /// resolved and it is filled again.
    std::array<Batch, 3>& batches() { return batches_; }

    const MemoryPlan& plan() const { return plan_; }
    /// The bytes of GL buffers and textures that are alive. At any time.
    uint64_t gpu_bytes() const { return gpu_bytes_; }

private:
    void set_plan(const MemoryPlan& whole);
    void demand(const MemoryPlan& whole);
    MemoryPlan plan_within(uint64_t bytes) const;
    Result<bool> update_in_place(const MemoryPlan& anew, const PageChanges& changes);
    Result<std::unique_ptr<Tracer>> make_tracer(GlState& state);
    Result<Done> open(BuildProgress* progress);
    void close();
    void bring_first(BuildProgress* progress);
    Moved move_in(std::span<const uint32_t> wanted);
    bool takes_measured() const;
    bool measures() const;
    ChosenVariants variants(GlState& state) const;
    void tune(GlState& state, SentRays& rays, const PassCost& pass);
    void send(GlState& state, Batch& batch, std::span<const uint32_t> wanted);
    void begin_to_collect();
    template <class Waits>
    void with_tracer(Waits&& waits);
    void finish(GlThread::Job& job);
    void collect(GlState& state, Batch& batch);
    void abandon();
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
    /// Whether the pool has the pages that the tracer believes it has: not where the first were not
    /// all brought, or a pass has failed. The next use then makes the tracer anew.
    bool is_whole_ = false;
    std::array<Batch, 3> batches_;
    std::deque<Batch*> sent_; // those that nobody collects yet, the first that was sent in front
    double seconds_a_ray_ = 1e-5; // of the pass before
    SharedBudget::Share share_;   // closes the tracer
};

} // namespace ovc
