// SPDX-License-Identifier: Apache-2.0
// BuildProgress: it decides when to report, and what.
#include "core/build_progress.h"

#include <algorithm>
#include <cassert>

namespace ovc {
namespace {

constexpr std::chrono::milliseconds kBetweenReports{20};

} // namespace

void BuildProgress::begin(const char* stage, double share, uint64_t work) {
    assert(stage);
    const std::lock_guard lock(mutex_);
    before_ += share_;
    share_ = share;
    stage_ = stage;
    work_ = std::max<uint64_t>(work, 1);
    done_ = 0;
    tell(before_, stage);
}

void BuildProgress::add(uint64_t units) {
    done_.fetch_add(units, std::memory_order_relaxed);
    if (cancelled_.load(std::memory_order_relaxed))
        throw Cancelled{};
    if (Clock::now().time_since_epoch().count() < next_.load(std::memory_order_relaxed))
        return;
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock || Clock::now().time_since_epoch().count() < next_)
        return; // another thread is reporting, or just did
    const double part = std::min(double(done_) / double(work_), 1.0);
    tell(before_ + share_ * part, stage_);
}

void BuildProgress::finish() {
    const std::lock_guard lock(mutex_);
    tell(1, "done");
}

void BuildProgress::tell(double done, const char* stage) {
    told_ = std::clamp(done, told_, 1.0);
    const bool go_on = report_(told_, stage);
    next_ = (Clock::now() + kBetweenReports).time_since_epoch().count();
    if (!go_on) {
        cancelled_ = true;
        throw Cancelled{};
    }
}

} // namespace ovc
