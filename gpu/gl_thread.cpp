// SPDX-License-Identifier: Apache-2.0
// GlThread: hand-over of one piece of work at a time.
#include "gpu/gl_thread.h"

#include <utility>

namespace ovc {

Result<std::unique_ptr<GlThread>> GlThread::start(const std::string& device, LogSink log) {
    std::unique_ptr<GlThread> self(new GlThread);
    self->thread_ =
        std::thread([&self = *self, device, log = std::move(log)] { self.serve(device, log); });
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

void GlThread::serve(const std::string& device, const LogSink& log) {
    Result<EglContext> context = EglContext::create(device, log);
    std::unique_lock lock(mutex_);
    if (!context) {
        started_ = context.error();
        changed_.notify_all();
        return;
    }
    GlState state{std::move(*context), DebugOutput(log), {}};
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
