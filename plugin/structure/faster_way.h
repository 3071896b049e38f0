// SPDX-License-Identifier: Apache-2.0
// FasterWay: which of two ways to answer calls is the faster one, measured now and then in short
// trials while the calls go on.
#pragma once

#include "plugin/structure/trial_verdict.h"

#include <algorithm>
#include <atomic>
#include <cassert>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace ovc {

/// Any number of threads may call it. The first way (0) is in use at the start. A trial is a slice
/// of time with the way in use, then one with the other. It counts how many calls end in the time
/// during which any is under way, so that the host's own work between its calls makes neither way
/// look slow.
class FasterWay {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;

    static constexpr auto kSlice = std::chrono::milliseconds(5);

    /// The way that a call takes.
    struct Use {
        int way;
        uint32_t slice; // 0: in no trial
    };

    Use begin(Time (*now)() = Clock::now) {
        const uint64_t state = state_.load(std::memory_order_relaxed);
        const Use use{int(state & 1), uint32_t(state >> 1)};
        if (use.slice != 0)
            enter(use, now);
        return use;
    }

    /// Ends the call that begin() returned `use` for. may_look: whether to look at the clock for
    /// the next trial; it suffices that some calls do.
    void end(const Use& use, bool may_look, Time (*now)() = Clock::now) {
        if (use.slice != 0)
            leave(use, now());
        else if (may_look)
            start_where_due(now());
    }

    int way() const { return int(state_ & 1); }

private:
    void enter(const Use& use, Time (*now)()) {
        const std::lock_guard lock(mutex_);
        if (is_current(use) && inside_++ == 0)
            busy_since_ = now();
    }

    void leave(const Use& use, Time now) {
        const std::lock_guard lock(mutex_);
        if (!is_current(use))
            return;
        assert(inside_ > 0); // enter() counted this call in the same slice
        ++ended_;
        --inside_;
        const bool over = now >= slice_end_;
        if (inside_ == 0 || over)
            busy_ += now - busy_since_;
        if (over)
            end_slice(use, now);
    }

    void start_where_due(Time now) {
        if (now.time_since_epoch().count() < next_trial_.load(std::memory_order_relaxed))
            return;
        const std::lock_guard lock(mutex_);
        if (slice() != 0 || now.time_since_epoch().count() < next_trial_)
            return;
        if (next_trial_ == 0) { // the first call of all
            next_trial_ = (now + verdict_.pause()).time_since_epoch().count();
            return;
        }
        incumbent_ = way();
        begin_slice(incumbent_, now);
    }

    void begin_slice(int way, Time now) {
        inside_ = 0;
        ended_ = 0;
        busy_ = {};
        slice_end_ = now + kSlice;
        state_ = uint64_t(++last_slice_) << 1 | uint64_t(way);
    }

    void end_slice(const Use& use, Time now) {
        rate_[use.way] = double(ended_) / std::max(busy_.count(), Clock::rep(1));
        if (use.way == incumbent_) {
            begin_slice(1 - incumbent_, now);
            return;
        }
        const bool changes = verdict_.changes(rate_[incumbent_], rate_[1 - incumbent_]);
        next_trial_ = (now + verdict_.pause()).time_since_epoch().count();
        state_ = uint64_t(changes ? 1 - incumbent_ : incumbent_);
    }

    uint32_t slice() const { return uint32_t(state_ >> 1); }
    bool is_current(const Use& use) const { return slice() == use.slice; }

    std::atomic<uint64_t> state_{0}; // the slice, and the way in the lowest bit
    std::atomic<Clock::rep> next_trial_{0};
    std::mutex mutex_; // guards the members below
    uint32_t last_slice_ = 0;
    int incumbent_ = 0;
    Time slice_end_, busy_since_;
    Clock::duration busy_{};
    TrialVerdict verdict_;
    uint64_t inside_ = 0, ended_ = 0; // calls that began in the slice
    double rate_[2]{};
};

} // namespace ovc
