// SPDX-License-Identifier: Apache-2.0
// SharedBudget: shares are max-min fair. Where not all scenes get what they have use for, those
// with less than an equal part get all of theirs, and the others divide the rest equally.
#include "gpu/budget/shared_budget.h"

#include <algorithm>
#include <cassert>
#include <chrono>

namespace ovc {

using Share = SharedBudget::Share;
using Use = SharedBudget::Use;

/// Returns the sum of all shares where none is larger than `level` without need.
uint64_t SharedBudget::sum_at(uint64_t level) const {
    uint64_t sum = 0;
    for (const Share* share : shares_)
        sum += std::min(share->max_, std::max(share->min_, level));
    return sum;
}

uint64_t SharedBudget::fair_bytes(const Share& share) const {
    uint64_t low = 0, high = bytes_ + 1;
    while (high - low > 1) {
        const uint64_t middle = low + (high - low) / 2;
        (sum_at(middle) <= bytes_ ? low : high) = middle;
    }
    return std::min(share.max_, std::max(share.min_, low));
}

/// Returns the bytes that others leave.
uint64_t SharedBudget::free_bytes(const Share& share) const {
    uint64_t free = bytes_;
    for (const Share* other : shares_)
        free -= other == &share ? 0 : other->bytes_;
    return free;
}

void SharedBudget::close(Share& share) {
    assert(share.user_ == std::thread::id());
    share.close_();
    share.bytes_ = 0;
}

/// Closes others until they leave so many bytes. A share that is open already takes from none but
/// those that have more than is fair. Returns whether there is room.
bool SharedBudget::make_room(const Share& share, uint64_t bytes) {
    const auto may_close = [&](const Share& other) {
        return &other != &share && other.bytes_ > 0 && other.user_ == std::thread::id() &&
               (share.bytes_ == 0 || other.bytes_ > fair_bytes(other));
    };
    while (free_bytes(share) < bytes) {
        Share* oldest = nullptr;
        for (Share* other : shares_)
            if (may_close(*other) && (!oldest || other->last_use_ < oldest->last_use_))
                oldest = other;
        if (!oldest)
            return false;
        close(*oldest);
    }
    return true;
}

/// Gives the share what it can have now. Returns false if that is of no use.
bool SharedBudget::grant(Share& share) {
    const uint64_t fair = fair_bytes(share);
    if (share.bytes_ >= fair - fair / 16) // all that was allocated goes where a share grows
        return true;
    const uint64_t bytes = make_room(share, fair) ? fair : free_bytes(share);
    if (bytes < share.min_)
        return false;
    if (bytes > share.bytes_) {
        if (share.bytes_ > 0)
            close(share);
        share.bytes_ = bytes;
    }
    return true;
}

/// Whether all threads that are within a Use wait for another share, so that no Use ends.
bool SharedBudget::nobody_works() const {
    return std::ranges::all_of(shares_, [&](const Share* share) {
        return share->user_ == std::thread::id() || waiting_.contains(share->user_);
    });
}

/// Whether shares are waited for, none of which can be granted as others are used now.
bool SharedBudget::nobody_may_begin() const {
    uint64_t used = 0, min = ~uint64_t(0);
    for (const Share* share : shares_) {
        used += share->user_ == std::thread::id() ? 0 : share->bytes_;
        min = share->is_wanted_ ? std::min(min, share->min_) : min;
    }
    return min != ~uint64_t(0) && min > bytes_ - used;
}

bool SharedBudget::is_inside(std::thread::id thread) const {
    return std::ranges::any_of(shares_, [&](const Share* s) { return s->user_ == thread; });
}

SharedBudget::Waiting::Waiting(SharedBudget& budget, Share* wanted)
    : budget_(budget), wanted_(wanted) {
    const std::lock_guard lock(budget_.mutex_);
    budget_.waiting_.insert(std::this_thread::get_id());
}

SharedBudget::Waiting::~Waiting() {
    const std::lock_guard lock(budget_.mutex_);
    budget_.waiting_.erase(std::this_thread::get_id());
    if (wanted_)
        wanted_->is_wanted_ = false;
}

bool SharedBudget::Waiting::is_in_vain(std::thread::id other) const {
    const std::lock_guard lock(budget_.mutex_);
    return budget_.is_inside(std::this_thread::get_id()) && budget_.waiting_.contains(other) &&
           budget_.nobody_works() && budget_.nobody_may_begin();
}

Share::Share(SharedBudget& budget, std::function<void()> close)
    : budget_(budget), close_(std::move(close)) {
    const std::lock_guard lock(budget_.mutex_);
    budget_.shares_.push_back(this);
}

Share::~Share() {
    close();
    const std::lock_guard lock(budget_.mutex_);
    std::erase(budget_.shares_, this);
}

void Share::demand(uint64_t min, uint64_t max) {
    assert(min <= max);
    const std::lock_guard lock(budget_.mutex_);
    assert(budget_.bytes_ == 0 || min <= budget_.bytes_);
    min_ = min;
    max_ = max;
}

void Share::close() {
    {
        const std::lock_guard lock(budget_.mutex_);
        budget_.close(*this);
    }
    budget_.changed_.notify_all();
}

Result<Use> Share::begin(const std::function<bool()>& goes_on) {
    if (budget_.bytes_ == 0) {
        bytes_ = max_;
        return Use();
    }
    const std::thread::id me = std::this_thread::get_id();
    const Waiting waiting(budget_, this); // until the lock is given back
    std::unique_lock lock(budget_.mutex_);
    const bool is_inside = budget_.is_inside(me);
    std::unique_lock<Turn> turn;
    if (!is_inside) { // otherwise the thread whose turn it is may wait for this call
        lock.unlock();
        if (!budget_.turn_.lock_while(goes_on))
            return Error{"cancelled", ErrorKind::Cancelled};
        turn = std::unique_lock(budget_.turn_, std::adopt_lock);
        lock.lock();
    }
    while (!budget_.grant(*this)) {
        if (bytes_ > 0)
            budget_.close(*this); // those that wait hold nothing, or two might wait for each other
        if (is_inside && budget_.nobody_works())
            return Error{"the scenes of the calls that this one comes from leave it no room in the "
                         "budget that they share",
                         ErrorKind::OverBudget};
        is_wanted_ = true;
        budget_.changed_.wait_for(lock, std::chrono::milliseconds(20));
        lock.unlock();
        if (!goes_on())
            return Error{"cancelled", ErrorKind::Cancelled};
        lock.lock();
    }
    budget_.waiting_.erase(me);
    user_ = me;
    last_use_ = ++budget_.clock_;
    return Use(*this);
}

Use::~Use() {
    if (!share_)
        return;
    {
        const std::lock_guard lock(share_->budget_.mutex_);
        share_->user_ = {};
    }
    share_->budget_.changed_.notify_all();
}

} // namespace ovc
