// SPDX-License-Identifier: Apache-2.0
// CallWatch: asks, while a call traces rays, whether it is to go on, is cancelled or has failed.
#pragma once

#include "core/result.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cstddef>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace ovc {

/// The side that waits for a call's rays and may cancel it.
class TraceWatch {
public:
    /// Returns false to stop the tracing. done: the share of the rays that is answered, 0 to 1.
    virtual bool goes_on(double done) = 0;

protected:
    ~TraceWatch() = default;
};

/// Holds the watch of the call under way, if it has one. Only keeps_on() may be called from any
/// thread.
class CallWatch {
public:
    /// While a Scope lives, `watch` (nullptr: nothing) is asked, on the thread that made the Scope.
    class Scope {
    public:
        Scope(CallWatch& call, TraceWatch* watch) : call_(call) {
            assert(!call.watch_); // calls take turns
            call.watch_ = watch;
            call.thread_ = std::this_thread::get_id();
            call.share_ = 0;
            call.begin_part(0, 1);
            call.cancelled_ = false;
        }
        ~Scope() { call_.watch_ = nullptr; }
        Scope(const Scope&) = delete;

    private:
        CallWatch& call_;
    };

    bool is_watched() const { return watch_ != nullptr; }

    /// Forgets what failed in an earlier call.
    void begin_call() {
        const std::lock_guard lock(mutex_);
        failure_.reset();
        has_failed_ = false;
    }
    /// Ends the call under way with this error, or with one before it. Any thread.
    void fail(Error error) {
        const std::lock_guard lock(mutex_);
        if (!failure_)
            failure_ = std::move(error);
        has_failed_ = true;
    }

    /// Begins part `part` of `parts` of the call, each of which traces rays.
    void begin_part(size_t part, size_t parts) {
        assert(part < parts);
        part_begin_ = double(part) / double(parts);
        part_length_ = 1 / double(parts);
    }
    /// Tells the watch, between passes, how many of the part's rays (> 0) are answered. Error of
    /// the kind Cancelled: the call is to end. Other errors: it has failed.
    Result<Done> go_on(size_t answered, size_t rays) {
        assert(answered <= rays && rays > 0);
        share_ = std::max(share_, part_begin_ + part_length_ * double(answered) / double(rays));
        keeps_on();
        return unless_cancelled();
    }
    /// Returns an error where the call has failed, and one of the kind Cancelled where it is
    /// cancelled. Calls end with this, because the answers of such a call are incomplete.
    Result<Done> unless_cancelled() const {
        if (has_failed_) {
            const std::lock_guard lock(mutex_);
            return *failure_;
        }
        if (watch_ && cancelled_)
            return Error{"cancelled", ErrorKind::Cancelled};
        return Done{};
    }
    /// Asks the watch within a pass, wherever something may take long. Returns false where the call
    /// is cancelled or has failed, and work on it is in vain; the watch is not asked again then.
    /// Any thread; those without the Scope only look up the answer.
    bool keeps_on() const {
        if (has_failed_)
            return false;
        if (!watch_)
            return true;
        const bool asks = !cancelled_ && thread_ == std::this_thread::get_id();
        if (asks && !watch_->goes_on(share_))
            cancelled_ = true;
        return !cancelled_;
    }

private:
    TraceWatch* watch_ = nullptr;
    std::thread::id thread_;
    double share_ = 0; // the answered part of the call's rays
    double part_begin_ = 0;
    double part_length_ = 1;
    mutable std::atomic<bool> cancelled_{false};
    std::atomic<bool> has_failed_{false};
    mutable std::mutex mutex_; // guards the next
    std::optional<Error> failure_;
};

} // namespace ovc
