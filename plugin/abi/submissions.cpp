// SPDX-License-Identifier: Apache-2.0
// Submissions: one thread runs the calls of the queue, one after the other, in their order.
#include "plugin/abi/submissions.h"

#include "core/system/blocked_signals.h"
#include "plugin/abi/submission.h"

#include <cassert>

namespace ovc {

bool Submissions::submit(std::shared_ptr<Submission> submission, const Work& work) {
    assert(submission && work);
    const std::lock_guard lock(mutex_);
    if (stopped_)
        return false;
    waiting_.push_back(std::move(submission));
    try {
        if (!thread_.joinable()) {
            const BlockedSignals blocked;
            thread_ = std::thread([this, work] { serve(work); });
        }
    } catch (...) {
        waiting_.pop_back();
        throw;
    }
    changed_.notify_all();
    return true;
}

void Submissions::stop() {
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        for (const auto& submission : waiting_)
            submission->cancel();
        changed_.notify_all();
    }
    if (thread_.joinable())
        thread_.join();
}

void Submissions::serve(const Work& work) {
    std::unique_lock lock(mutex_);
    while (true) {
        changed_.wait(lock, [&] { return !waiting_.empty() || stopped_; });
        if (waiting_.empty())
            return;
        const std::shared_ptr<Submission> next = waiting_.front();
        lock.unlock();
        work(*next);
        lock.lock();
        assert(waiting_.front() == next); // others only add behind it
        waiting_.pop_front();
    }
}

} // namespace ovc
