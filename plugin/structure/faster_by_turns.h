// SPDX-License-Identifier: Apache-2.0
// FasterByTurns: which of two ways to answer batches of rays is the faster one, measured now and
// then while the host asks them.
#pragma once

#include "plugin/structure/trial_verdict.h"

#include <algorithm>
#include <chrono>
#include <cstdint>
#include <mutex>

namespace ovc {

/// Any number of threads may call it. The first way (0) is in use at the start. In a trial a few
/// batches go one way, then a few the other, by turns, so that both get the like of what the host
/// asks: slices of time, as FasterWay has them, would compare the sky with the trees. The first
/// batch of a turn does not count, for it finds the threads of its way asleep.
class FasterByTurns {
public:
    using Clock = std::chrono::steady_clock;
    using Time = Clock::time_point;

    static constexpr uint32_t kBatchesBetween = 64; // at least, before a trial
    static constexpr uint32_t kTurn = 8;            // batches that go one way in turn
    static constexpr uint32_t kTurns = 8;           // of a trial

    /// A batch on its way, whose end the destructor tells. work: how much the batch does, in a unit
    /// that all share.
    class Batch {
    public:
        Batch(FasterByTurns& ways, uint64_t work, Time (*now)() = Clock::now)
            : ways_(ways), now_(now), work_(work), begin_(now()) {
            ways_.begin(*this);
        }
        ~Batch() {
            if (trial_ != 0)
                ways_.end(*this, now_() - begin_);
        }
        Batch(const Batch&) = delete;

        int way() const { return way_; }

    private:
        friend class FasterByTurns;
        FasterByTurns& ways_;
        Time (*const now_)();
        const uint64_t work_;
        const Time begin_;
        int way_ = 0;
        uint32_t trial_ = 0; // 0: of none
    };

private:
    void begin(Batch& batch) {
        const std::lock_guard lock(mutex_);
        if (begun_ == kBatches && ++batches_since_ >= kBatchesBetween &&
            batch.begin_ >= next_trial_) {
            ++trial_;
            begun_ = ended_ = batches_since_ = 0;
            for (Taken& taken : taken_)
                taken = {};
        }
        batch.way_ = way_;
        if (begun_ == kBatches)
            return;
        batch.way_ = int(begun_ / kTurn % 2);
        batch.trial_ = begun_++ % kTurn == 0 ? 0 : trial_;
    }

    void end(const Batch& batch, Clock::duration time) {
        const std::lock_guard lock(mutex_);
        if (batch.trial_ != trial_)
            return;
        taken_[batch.way_].time += time;
        taken_[batch.way_].work += double(batch.work_);
        if (++ended_ < kTurns * (kTurn - 1))
            return;
        if (verdict_.changes(taken_[way_].rate(), taken_[1 - way_].rate()))
            way_ = 1 - way_;
        next_trial_ = batch.begin_ + verdict_.pause();
    }

    static constexpr uint32_t kBatches = kTurns * kTurn; // of a trial

    struct Taken {
        Clock::duration time{};
        double work = 0;

        double rate() const { return work / double(std::max(time.count(), Clock::rep(1))); }
    };

    std::mutex mutex_; // guards all
    int way_ = 0;
    uint32_t trial_ = 0;
    uint32_t begun_ = kBatches, ended_ = 0; // batches of the trial; all have begun: none is on
    uint32_t batches_since_ = 0;
    Taken taken_[2];
    TrialVerdict verdict_;
    Time next_trial_{};
};

} // namespace ovc
