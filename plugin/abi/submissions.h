// SPDX-License-Identifier: Apache-2.0
// Submissions: the queue of a scene, and the thread that does what is in it, which begins with the
// first.
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
    /// work(submission) does one, from its beginning to its end, and throws nothing.
    using Work = std::function<void(Submission&)>;

    ~Submissions() { stop(); }

    /// false: stopped, it will not be done. Always with the same work.
    bool submit(std::shared_ptr<Submission> submission, const Work& work);

    /// Cancels all, and returns when they are done. Afterwards none is taken.
    void stop();

private:
    void serve(const Work& work);

    std::mutex mutex_; // of what is below
    std::condition_variable changed_;
    std::deque<std::shared_ptr<Submission>> waiting_; // the first may be under way
    bool stopped_ = false;
    std::thread thread_;
};

} // namespace ovc
