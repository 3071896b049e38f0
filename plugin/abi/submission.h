// SPDX-License-Identifier: Apache-2.0
// Submission: a call of intersect or occluded that somebody else does, and what became of it.
#pragma once

#include "core/text/format_text.h"
#include "plugin/abi/asked_progress.h"
#include "plugin/abi/ray_call.h"

#include <atomic>
#include <condition_variable>
#include <mutex>
#include <string>

namespace ovc {

/// One thread does it, any number ask. It begins once, unless it was cancelled before, and ends
/// once.
class Submission final : public TraceWatch {
public:
    struct Outcome {
        ovc_result result = OVC_OK;
        std::string message;

        void set(ovc_result code, std::string text) { *this = {code, std::move(text)}; }
    };

    explicit Submission(const RayCall& call) : call_(call) {}

    const RayCall& call() const { return call_; }

    /// Who does it. false: it was cancelled, nothing is to be done.
    bool begin() {
        const std::lock_guard lock(mutex_);
        begun_ = true;
        return !done_;
    }
    void end(Outcome outcome) {
        const std::lock_guard lock(mutex_);
        finish(std::move(outcome));
    }
    /// Between passes.
    bool goes_on(double done) override {
        progress_ = done;
        return !cancelled_ && asked_.goes_on(done);
    }

    /// Who asked for it: ends it at once where it has not begun, else soon.
    void cancel() {
        const std::lock_guard lock(mutex_);
        cancelled_ = true;
        if (!begun_ && !done_)
            finish({OVC_ERROR_CANCELLED, format_text("{}: cancelled", call_.name)});
    }
    bool done() const {
        const std::lock_guard lock(mutex_);
        return done_;
    }
    double progress() const { return progress_; }

    /// may_wait() is asked where it is not done; while it runs, it does not get done.
    template <class MayWait>
    Outcome wait(MayWait&& may_wait) {
        std::unique_lock lock(mutex_);
        if (!done_)
            may_wait();
        ended_.wait(lock, [&] { return done_; });
        return outcome_;
    }

private:
    void finish(Outcome outcome) {
        outcome_ = std::move(outcome);
        if (outcome_.result == OVC_OK)
            progress_ = 1;
        done_ = true;
        ended_.notify_all();
    }

    const RayCall call_;
    HostFloatMode mode_; // of the thread that submitted it
    AskedProgress asked_{call_.query, mode_};
    std::atomic<double> progress_{0};
    std::atomic<bool> cancelled_{false};
    mutable std::mutex mutex_; // of what is below
    std::condition_variable ended_;
    bool begun_ = false;
    bool done_ = false;
    Outcome outcome_;
};

} // namespace ovc
