// SPDX-License-Identifier: Apache-2.0
// Gathering: rays that threads ask about one by one, in batches. While one of the threads traces
// what has come, the next batch comes together.
#pragma once

#include "core/ray.h"

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
    TriangleId skip;
    Hit hit{};             // where not any_hit
    bool occluded = false; // where any_hit
};

class Gathering {
public:
    /// Returns when `asked` is answered; false: it was in a batch that could not be traced.
    /// trace(batch) -> bool is called by whichever thread finds that no batch is under way, for
    /// all that have come until then, so that a ray waits for two batches at most.
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
            return false; // each thread does without
        }
    }

    std::mutex mutex_; // of what is below, but for whom the batch is of
    std::condition_variable changed_;
    std::vector<Request*> waiting_;
    bool under_way_ = false;
    std::vector<Request*> batch_;
    std::vector<SingleRay*> rays_;
};

} // namespace ovc
