// SPDX-License-Identifier: Apache-2.0
// Gathering: collects what many threads ask at once, rays or batches of them. While one of the
// threads traces what has come, the next to be traced together come in.
#pragma once

#include <cassert>
#include <condition_variable>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

/// Asked: what one thread asks, and its answer.
template <class Asked>
class Gathering {
public:
    /// Returns true when `asked` is answered, false when its batch could not be traced. Any thread.
    /// The thread that finds no batch under way calls trace(batch) -> bool for all that have come
    /// until then, so that each waits for two batches at most. An exception of trace() counts as
    /// false.
    template <class Trace>
    bool answer(Asked& asked, Trace&& trace) {
        Request request{&asked};
        std::unique_lock lock(mutex_);
        waiting_.push_back(&request);
        while (request.state == Request::Waits) {
            if (std::exchange(under_way_, true)) {
                changed_.wait(lock, [&] { return request.state != Request::Waits || !under_way_; });
                continue;
            }
            std::swap(waiting_, batch_);
            assert(waiting_.empty() && !batch_.empty()); // what this thread asks is in the batch
            lock.unlock();
            const bool traced = run(trace);
            lock.lock();
            for (Request* done : batch_)
                done->state = traced ? Request::Answered : Request::Refused;
            batch_.clear();
            under_way_ = false;
            changed_.notify_all();
        }
        return request.state == Request::Answered;
    }

private:
    struct Request {
        Asked* asked;
        enum { Waits, Answered, Refused } state = Waits;
    };

    template <class Trace>
    bool run(Trace&& trace) noexcept {
        try {
            asked_.clear();
            for (Request* request : batch_)
                asked_.push_back(request->asked);
            return trace(std::span<Asked* const>(asked_));
        } catch (...) {
            return false; // each thread then answers its own
        }
    }

    /// Guards the members below; batch_ and asked_ belong to the thread that traces.
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Request*> waiting_;
    bool under_way_ = false;
    std::vector<Request*> batch_;
    std::vector<Asked*> asked_;
};

} // namespace ovc
