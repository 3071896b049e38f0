// SPDX-License-Identifier: Apache-2.0
// Submissions: a scene's queue of submitted calls, and the thread that runs them, which starts with
// the first.
#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace ovc {

class Submission;

class Submissions {
public:
    /// work(submission) runs one, from its beginning to its end, and throws nothing.
    using Work = std::function<void(Submission&)>;

    ~Submissions() { stop(); }

    /// Adds a call to the queue. Returns false after stop(), where it is not run. work: the same in
    /// every call of this.
    bool submit(std::shared_ptr<Submission> submission, const Work& work);

    /// Cancels all calls in the queue, and returns when they are done. No more are taken
    /// afterwards.
    void stop();

private:
    void serve(const Work& work);

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    /// The first may be under way. The host's ticket shares each: the host may release it while the
    /// queue's thread still ends it.
    std::deque<std::shared_ptr<Submission>> waiting_;
    bool stopped_ = false;
    std::thread thread_;
};

} // namespace ovc
