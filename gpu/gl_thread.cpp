// SPDX-License-Identifier: Apache-2.0
// GlThread: hand-over of one piece of work at a time.
#include "gpu/gl_thread.h"

#include <utility>

namespace ovc {

Result<std::unique_ptr<GlThread>> GlThread::start(const std::string& device, LogSink log) {
    std::unique_ptr<GlThread> self(new GlThread(device, std::move(log)));
    self->thread_ = std::thread([&self = *self] { self.serve(); });
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
    thread_.join();
}

void GlThread::execute(const std::function<void(GlState&)>& work) {
    const std::lock_guard turn(turn_);
    std::unique_lock lock(mutex_);
    work_ = &work;
    done_ = false;
    changed_.notify_all();
    changed_.wait(lock, [&] { return done_; });
    if (thrown_)
        std::rethrow_exception(std::exchange(thrown_, nullptr));
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

void GlThread::serve() {
    Result<EglContext> context = EglContext::create(device_, log_);
    std::unique_lock lock(mutex_);
    if (!context) {
        started_ = context.error();
        changed_.notify_all();
        return;
    }
    GlState state{std::move(*context), DebugOutput(log_), {}, gl::context_generation};
    info_ = state.context.info();
    started_ = Done{};
    changed_.notify_all();
    while (true) {
        changed_.wait(lock, [&] { return work_ || stop_; });
        if (!work_)
            break;
        const std::function<void(GlState&)>& work = *std::exchange(work_, nullptr);
        lock.unlock();
        std::exception_ptr thrown;
        try {
            work(state);
        } catch (...) {
            thrown = std::current_exception();
        }
        lock.lock();
        thrown_ = thrown;
        done_ = true;
        changed_.notify_all();
    }
}

} // namespace ovc
