// SPDX-License-Identifier: Apache-2.0
// Submission: a submitted call of intersect or occluded, which another thread runs, and its
// outcome.
#pragma once

#include "core/text/format_text.h"
#include "plugin/abi/asked_progress.h"
#include "plugin/abi/ray_call.h"

#include <atomic>
#include <cassert>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <string>

namespace ovc {

/// One thread runs it, any number of threads ask about it. It ends once, and begins before unless
/// it is cancelled first.
class Submission final : public TraceWatch {
public:
    struct Outcome {
        ovc_result result = OVC_OK;
        std::string message;

        void set(ovc_result code, std::string text) { *this = {code, std::move(text)}; }
    };

    /// mode: of the thread that submits it.
    Submission(const RayCall& call, const HostFloatMode& mode)
        : call_(call), mode_(mode), was_cancelled_(format_text("{}: cancelled", call.name)) {}

    const RayCall& call() const { return call_; }

    /// Called by the thread that runs it. Returns false where it is cancelled already, and nothing
    /// is to be done.
    bool begin() {
        const std::lock_guard lock(mutex_);
        assert(!begun_);
        begun_ = true;
        return !done_;
    }
    void end(Outcome outcome) {
        const std::lock_guard lock(mutex_);
        assert(begun_);
        finish(std::move(outcome));
    }
    /// Asked by the thread that runs it, between passes.
    bool goes_on(double done) override {
        progress_ = done;
        return !cancelled_ && asked_.goes_on(done);
    }

    /// Ends it at once where it has not begun, else soon. Any thread, as all that follow.
    void cancel() noexcept {
        const std::lock_guard lock(mutex_);
        cancelled_ = true;
        if (!begun_ && !done_)
            finish({OVC_ERROR_CANCELLED, std::move(was_cancelled_)});
    }
    bool done() const {
        const std::lock_guard lock(mutex_);
        return done_;
    }
    double progress() const { return progress_; }

    /// Returns the outcome, as soon as there is one. Where it is not done yet, calls may_wait()
    /// now and then, which may throw; until that returns, it does not get done.
    template <class MayWait>
    Outcome wait(MayWait&& may_wait) {
        std::unique_lock lock(mutex_);
        const auto is_done = [&] { return done_; };
        do {
            if (!done_)
                may_wait();
        } while (!ended_.wait_for(lock, std::chrono::milliseconds(20), is_done));
        return outcome_;
    }
    void wait_until_done() noexcept {
        std::unique_lock lock(mutex_);
        ended_.wait(lock, [&] { return done_; });
    }

private:
    void finish(Outcome&& outcome) {
        assert(!done_);
        outcome_ = std::move(outcome);
        if (outcome_.result == OVC_OK)
            progress_ = 1;
        done_ = true;
        ended_.notify_all();
    }

    const RayCall call_;
    HostFloatMode mode_;
    AskedProgress asked_{call_.query, mode_};
    std::atomic<double> progress_{0};
    std::atomic<bool> cancelled_{false};
    mutable std::mutex mutex_; // guards the members below
    std::condition_variable ended_;
    bool begun_ = false;
    bool done_ = false;
    std::string was_cancelled_; // made early, so that cancel() needs no memory
    Outcome outcome_;
};

} // namespace ovc
