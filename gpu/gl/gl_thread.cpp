// SPDX-License-Identifier: Apache-2.0
// GlThread: hands pieces of work over to the thread, first come, first served.
#include "gpu/gl/gl_thread.h"

#include "core/system/blocked_signals.h"
#include "core/system/caught_error.h"
#include "gpu/driver/driver_threads.h"

#include <chrono>
#include <utility>

namespace ovc {

Result<std::unique_ptr<GlThread>> GlThread::start(const std::string& device, LogSink log,
                                                  const DeviceLimits& limits) {
    std::unique_ptr<GlThread> self(new GlThread(device, std::move(log), limits));
    {
        const BlockedSignals blocked;
        self->thread_ = std::thread([&self = *self] { self.serve(); });
    }
    std::unique_lock lock(self->mutex_);
    self->changed_.wait(lock, [&] { return self->started_.has_value(); });
    const Result<Done> started = *self->started_;
    lock.unlock();
    if (!started)
        return started.error();
    return self;
}

GlThread::~GlThread() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    changed_.notify_all();
    if (thread_.joinable()) // false if the system refused to start it
        thread_.join();
}

void GlThread::execute(std::function<void(GlState&)> work) {
    Job job;
    begin(job, std::move(work));
    finish(job, [] {});
}

void GlThread::begin(Job& job, std::function<void(GlState&)> work) {
    {
        const std::lock_guard lock(mutex_);
        assert(job.is_done_);
        job.work_ = std::move(work);
        job.thrown_ = {};
        job.is_done_ = false;
        job.next_ = nullptr;
        *std::exchange(end_of_jobs_, &job.next_) = &job;
    }
    changed_.notify_all();
}

void GlThread::finish(Job& job, const std::function<void()>& idle) {
    constexpr std::chrono::milliseconds kBetweenCalls(10);
    std::unique_lock lock(mutex_);
    while (!job.done_.wait_for(lock, kBetweenCalls, [&] { return job.is_done_; })) {
        lock.unlock();
        idle();
        lock.lock();
    }
    if (job.thrown_)
        std::rethrow_exception(std::exchange(job.thrown_, {}));
}

Result<Done> GlThread::reopen(uint32_t generation) {
    Result<Done> done = Done{};
    execute([&](GlState& state) {
        if (state.generation != generation)
            return;
        generation_ = state.generation = ++gl::context_generation;
        state.kernels = {};
        state.context.lose();
        Result<EglContext> context = EglContext::create(device_, {});
        if (!context) {
            done = Error{context.error().message, ErrorKind::DeviceLost};
            return;
        }
        if (context->info().renderer != info_.renderer) {
            done = Error{"'" + info_.renderer + "' is gone; there is '" + context->info().renderer +
                             "', for which a new device must be created",
                         ErrorKind::DeviceLost};
            return;
        }
        state.context = std::move(*context);
        state.debug = DebugOutput(log_);
    });
    return done;
}

/// Forgets the names of a dead context. Deleting them would call GL without a context.
void GlThread::forget_if_dead(GlState& state) {
    if (gl::context_generation != state.generation || state.context.alive())
        return;
    ++gl::context_generation;
    state.context.lose();
}

/// Opens the device. What is thrown for lack of memory becomes an error, because it would end the
/// process if it left the thread.
Result<Done> GlThread::open(std::optional<GlState>& state) noexcept {
    try {
        if (limits_.threads > 0)
            keep_to_cores(limits_.threads); // as do the threads that the driver starts from here
        Result<EglContext> context = EglContext::create(device_, log_);
        if (!context)
            return context.error();
        info_ = context->info();
        info_.shared_budget_bytes = budget_.bytes();
        state.emplace(
            GlState{std::move(*context), DebugOutput(log_), {}, {}, gl::context_generation});
        return Done{};
    } catch (...) {
        return caught_error();
    }
}

void GlThread::serve() {
    name_device_thread();
    std::optional<LoopThreads::Scope> loops;
    if (limits_.loops)
        loops.emplace(*limits_.loops);
    std::optional<GlState> state;
    Result<Done> opened = open(state);
    std::unique_lock lock(mutex_);
    started_ = std::move(opened);
    changed_.notify_all();
    while (state) {
        changed_.wait(lock, [&] { return first_job_ || stop_; });
        if (!first_job_)
            break;
        Job& job = *first_job_;
        lock.unlock();
        std::exception_ptr thrown;
        forget_if_dead(*state);
        try {
            job.work_(*state);
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        first_job_ = job.next_;
        if (!first_job_)
            end_of_jobs_ = &first_job_;
        job.thrown_ = thrown;
        job.is_done_ = true;
        job.done_.notify_all(); // once the mutex is free, the job may be gone
    }
}

} // namespace ovc
