// SPDX-License-Identifier: Apache-2.0
// The loop of algorithm 5 traces rays, shades hits and asks for shadows until no rays are left, and
// goes on with the next pixels. Two lanes run it side by side: while one traces, the other shades.
#include "host/render/render_batched.h"

#include "core/system/parallel.h"
#include "core/system/stopwatch.h"
#include "core/system/turn_order.h"
#include "host/shade/shading.h"

#include <algorithm>
#include <atomic>
#include <future>
#include <optional>
#include <system_error>
#include <utility>

namespace ovc {
namespace {

/// A batch has so many rays for each core. Their data stays in caches, and they go through so small
/// a part of the picture that under a budget most find their pages in the pool (decision 19). A
/// picture has a minimum of batches, as long as these are no trifles: or a lane would have nothing
/// to do while the other traces, and small pictures would pay most for memory that is new.
constexpr uint64_t kRaysACore = 1 << 14;
constexpr uint64_t kMinBatches = 24, kMinRays = 1024;

constexpr size_t kMaxLanes = 2;
/// A backend that traces for more of the time than this counts as always busy: what is left goes
/// into handing over batches.
constexpr double kBusy = 0.75;

/// The state that both lanes share: the camera's rays, and the backend, which answers one call at a
/// time. Where pages are moved, lanes take turns in their order: which pages move is the same in
/// every run then. Elsewhere none waits for another's shading.
class Work {
public:
    Work(const RenderTask& task, Backend& backend, size_t lanes)
        : task_(task), backend_(backend), turns_(lanes, backend.moves_pages()) {}

    const RenderTask& task() const { return task_; }
    TurnOrder& turns() { return turns_; }

    /// Makes the next camera rays, at most `max_count`. Returns false where none are left.
    bool begin(size_t lane, size_t max_count, RayList<Path>& paths) {
        const uint64_t first =
            turns_.take(lane, [&] { return std::exchange(begun_, begun_ + max_count); });
        const CameraRays& camera = task_.camera;
        if (first >= camera.size())
            return false;
        camera.make(first, std::min<uint64_t>(max_count, camera.size() - first), paths);
        return true;
    }

    /// Runs ask(backend), which traces `rays`. Returns false where the rendering has stopped; the
    /// answers do not count then.
    template <class Ask>
    bool trace(size_t lane, const RayCounts& rays, Ask&& ask) {
        return turns_.take(lane, [&] {
            if (stopped_)
                return false;
            const LoopThreads::Scope scope(all_threads_);
            const Stopwatch watch;
            const Result<Done> done = ask(backend_);
            report_.seconds_trace += watch.seconds();
            backend_is_busy_ = report_.seconds_trace > kBusy * since_begin_.seconds();
            if (!done)
                error_ = done.error();
            report_.rays += rays;
            report_.pixels_done = task_.film.pixels_done();
            stopped_ = !done || (task_.observe && !task_.observe(report_));
            return !stopped_;
        });
    }

    /// Returns the threads on which a lane makes and shades rays; own: the one that the lane has. A
    /// lane that has a core keeps to that: the rays stay in the core's cache, and no threads look
    /// for work between short loops. But a backend that is always busy soon waits for the lane,
    /// which therefore gets all threads.
    LoopThreads& threads(LoopThreads& own) {
        return has_cores_ && !backend_is_busy_ ? own : all_threads_;
    }

    void shaded_for(size_t lane, double seconds) {
        turns_.take(lane, [&] { report_.seconds_shade += seconds; });
    }

    Result<RenderReport> report() {
        if (error_)
            return *error_;
        report_.complete = !stopped_;
        return report_;
    }

private:
    const RenderTask& task_;
    Backend& backend_;
    const bool has_cores_ = thread_count() <= kMaxLanes; // one for each lane
    LoopThreads all_threads_{0};                         // also of a backend in this program
    const Stopwatch since_begin_;
    std::atomic<bool> backend_is_busy_{false};
    TurnOrder turns_;
    // Like the backend, these are for the lane whose turn it is.
    uint64_t begun_ = 0; // camera rays
    bool stopped_ = false;
    std::optional<Error> error_;
    RenderReport report_;
};

class Lane {
public:
    Lane(Work& work, size_t number, size_t batch_rays)
        : work_(work),
          number_(number),
          shading_(work.task().integrator, work.task().film),
          batch_rays_(batch_rays) {
        spawned_.shadows.reserve(batch_rays);
    }

    void run() {
        const Stopwatch watch;
        while (begin())
            while (!spawned_.paths.empty()) {
                take_waiting();
                if (!trace_paths() || !shade())
                    return;
                reuse(now_, spawned_.paths);
            }
        work_.shaded_for(number_, watch.seconds() - seconds_tracing_);
    }

private:
    bool begin() {
        const LoopThreads::Scope scope(work_.threads(own_thread_));
        return work_.begin(number_, batch_rays_, spawned_.paths);
    }

    bool trace_paths() {
        RayCounts rays;
        for (const Path& path : now_.purposes)
            rays.count(path.kind);
        hits_.resize(now_.size());
        const Exclusions without = excluded(now_);
        return trace(
            rays, [&](Backend& backend) { return backend.intersect(now_.rays, without, hits_); });
    }

    bool shade() {
        const LoopThreads::Scope scope(work_.threads(own_thread_));
        const size_t piece = shading_.max_answers();
        for (size_t first = 0; first < now_.size(); first += piece) {
            shading_.shade(now_, hits_, first, std::min(piece, now_.size() - first), spawned_);
            const bool last = first + piece >= now_.size();
            if ((last || spawned_.shadows.size() >= batch_rays_) && !trace_shadows())
                return false;
        }
        return true;
    }

    bool trace_shadows() {
        while (!spawned_.shadows.empty()) {
            spawned_.shadows.move_tail(
                spawned_.shadows.size() - std::min(spawned_.shadows.size(), batch_rays_), shadows_);
            while (!shadows_.empty())
                if (!(work_.task().integrator.light_may_pass() ? pass() : arrive()))
                    return false;
            reuse(shadows_, spawned_.shadows);
        }
        return true;
    }

    bool arrive() {
        occluded_.resize(shadows_.size());
        const Exclusions without = excluded(shadows_);
        if (!trace({.shadow = shadows_.size()}, [&](Backend& backend) {
                return backend.occluded(shadows_.rays, without, occluded_);
            }))
            return false;
        shading_.arrive(shadows_.purposes, occluded_);
        shadows_.resize(0);
        return true;
    }

    bool pass() {
        shadow_hits_.resize(shadows_.size());
        const Exclusions without = excluded(shadows_);
        if (!trace({.shadow = shadows_.size()}, [&](Backend& backend) {
                return backend.intersect(shadows_.rays, without, shadow_hits_);
            }))
            return false;
        shading_.pass(shadows_, shadow_hits_);
        return true;
    }

    /// Returns what the rays do not see; its masks lie in masks_.
    template <class Purpose>
    Exclusions excluded(const RayList<Purpose>& rays) {
        Exclusions without(rays.skip);
        without.sieves = work_.task().sight.of(rays.purposes, masks_);
        return without;
    }

    template <class Ask>
    bool trace(const RayCounts& rays, Ask&& ask) {
        const Stopwatch watch;
        const bool goes_on = work_.trace(number_, rays, ask);
        seconds_tracing_ += watch.seconds();
        return goes_on;
    }

    /// Moves the rays to trace next into now_: all that wait, as long as a batch holds them. Where
    /// splitting rays have made more, it takes the last few, which are the deepest, because n rays
    /// leave at most 2 n.
    void take_waiting() {
        RayList<Path>& waiting = spawned_.paths;
        const size_t few =
            waiting.size() > batch_rays_ ? std::max<size_t>(batch_rays_ / 8, 1) : waiting.size();
        waiting.move_tail(waiting.size() - few, now_);
    }

    /// Gives the memory of rays that are done to those that come next, if none has come yet.
    template <class Purpose>
    static void reuse(RayList<Purpose>& done, RayList<Purpose>& next) {
        done.resize(0);
        if (next.empty())
            std::swap(done, next);
    }

    Work& work_;
    const size_t number_;
    Shading shading_;
    const size_t batch_rays_;
    LoopThreads own_thread_{1};
    double seconds_tracing_ = 0; // tracing, or waiting for the other lane's tracing
    // These buffers are kept between rounds so that they are allocated once.
    Spawned spawned_;         // rays that wait, the deepest last
    RayList<Path> now_;       // rays that are being traced
    RayList<Shadow> shadows_; // likewise
    UnwrittenVector<Hit> hits_;
    UnwrittenVector<Hit> shadow_hits_;
    std::vector<uint8_t> occluded_;
    std::vector<uint32_t> masks_;
};

} // namespace

Result<RenderReport> render_batched(const RenderTask& task, Backend& backend, size_t batch_rays) {
    const uint64_t wanted =
        std::clamp(task.camera.size() / kMinBatches + 1, kMinRays, kRaysACore * thread_count());
    const size_t batch = size_t(std::min<uint64_t>(batch_rays, wanted));
    const size_t lanes = std::min(kMaxLanes, thread_count());
    Work work(task, backend, lanes);
    const auto run = [&](size_t lane) {
        const TurnOrder::Seat seat(work.turns(), lane);
        Lane(work, lane, batch).run();
    };
    std::vector<std::future<void>> others;
    for (size_t lane = 1; lane < lanes; ++lane)
        try {
            others.push_back(std::async(std::launch::async, run, lane));
        } catch (const std::system_error&) { // no thread is left: the first lane does it all
            work.turns().leave(lane);
        }
    run(0);
    for (std::future<void>& other : others)
        other.get();
    return work.report();
}

} // namespace ovc
