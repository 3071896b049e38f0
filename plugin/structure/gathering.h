// SPDX-License-Identifier: Apache-2.0
// Gathering: collects rays that threads ask about one by one into batches. While one of the threads
// traces a batch, the next one fills.
#pragma once

#include "core/exclusions.h"

#include <cassert>
#include <condition_variable>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace ovc {

/// One ray, and its answer.
struct SingleRay {
    bool any_hit = false;
    Ray ray;
    Exclusion without;
    RaySieve sieve;
    Hit hit{};             // the answer unless any_hit
    bool occluded = false; // the answer if any_hit
};

class Gathering {
public:
    /// Returns true when `asked` is answered, false when its batch could not be traced. Any thread.
    /// The thread that finds no batch under way calls trace(batch) -> bool for all rays that have
    /// come until then, so that a ray waits for two batches at most. An exception of trace() counts
    /// as false.
    template <class Trace>
    bool answer(SingleRay& asked, Trace&& trace) {
        Request request{&asked};
        std::unique_lock lock(mutex_);
        waiting_.push_back(&request);
        while (request.state == Request::Waits) {
            if (std::exchange(under_way_, true)) {
                changed_.wait(lock, [&] { return request.state != Request::Waits || !under_way_; });
                continue;
            }
            std::swap(waiting_, batch_);
            assert(waiting_.empty() && !batch_.empty()); // this thread's ray is in the batch
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
        SingleRay* ray;
        enum { Waits, Answered, Refused } state = Waits;
    };

    template <class Trace>
    bool run(Trace&& trace) noexcept {
        try {
            rays_.clear();
            for (Request* request : batch_)
                rays_.push_back(request->ray);
            return trace(std::span<SingleRay* const>(rays_));
        } catch (...) {
            return false; // each thread then answers its own ray
        }
    }

    /// Guards the members below; batch_ and rays_ belong to the thread that traces.
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Request*> waiting_;
    bool under_way_ = false;
    std::vector<Request*> batch_;
    std::vector<SingleRay*> rays_;
};

} // namespace ovc
