// SPDX-License-Identifier: Apache-2.0
// CallWatch: whether a call that traces rays is to go on.
#pragma once

#include "core/result.h"

#include <atomic>
#include <cstddef>
#include <thread>

namespace ovc {

/// Who waits for rays, and may stop their tracing.
class TraceWatch {
public:
    /// done: the share of the rays that is answered. false: stop.
    virtual bool goes_on(double done) = 0;

protected:
    ~TraceWatch() = default;
};

/// What the call under way asks as it goes on: the watch that it was given, if it was given one.
class CallWatch {
public:
    /// While it lives, `watch`, which may be nullptr, is asked, on this thread alone.
    class Scope {
    public:
        Scope(CallWatch& call, TraceWatch* watch) : call_(call) {
            call.watch_ = watch;
            call.thread_ = std::this_thread::get_id();
            call.share_ = 0;
            call.cancelled_ = false;
        }
        ~Scope() { call_.watch_ = nullptr; }
        Scope(const Scope&) = delete;

    private:
        CallWatch& call_;
    };

    bool is_watched() const { return watch_ != nullptr; }

    /// What a call of so many rays asks between passes.
    Result<Done> go_on(size_t answered, size_t rays) {
        share_ = double(answered) / double(rays);
        keeps_on();
        return unless_cancelled();
    }
    /// What a call returns at its end, because the answers of a cancelled call are incomplete.
    Result<Done> unless_cancelled() const {
        if (watch_ && cancelled_)
            return Error{"cancelled", ErrorKind::Cancelled};
        return Done{};
    }
    /// The same within a pass, from any thread, as often as something may take long. false: the
    /// call is cancelled, and work on it is in vain.
    bool keeps_on() const {
        if (!watch_)
            return true;
        if (thread_ == std::this_thread::get_id() && !watch_->goes_on(share_))
            cancelled_ = true;
        return !cancelled_;
    }

private:
    TraceWatch* watch_ = nullptr;
    std::thread::id thread_;
    double share_ = 0; // of the call's rays that is answered
    mutable std::atomic<bool> cancelled_{false};
};

} // namespace ovc
