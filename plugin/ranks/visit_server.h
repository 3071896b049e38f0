// SPDX-License-Identifier: Apache-2.0
// VisitServer: traces the rays that visit this rank, its own and those of others, through the pages
// that it has. It works beside all calls of the host, so no rank waits for another to call.
#pragma once

#include "core/system/parallel.h"
#include "plugin/ranks/transport/transport.h"
#include "plugin/structure/structure.h"

#include <atomic>
#include <memory>
#include <mutex>
#include <thread>
#include <vector>

namespace ovc {

class VisitServer {
public:
    /// local: traces through the pages of this rank; only the server calls it from now on. threads:
    /// those that loops run on, or null.
    VisitServer(Structure& local, Transport& transport, LoopThreads* threads);
    ~VisitServer();
    VisitServer(const VisitServer&) = delete;

    /// Whether there are no rays to trace just now.
    bool is_idle() const { return is_idle_; }
    /// Returns how many rays of other ranks were traced.
    uint64_t served() const { return served_; }
    /// Returns what is counted of what traces here.
    ovc_statistics report() {
        const std::lock_guard lock(local_mutex_);
        return local_.report();
    }
    /// Gives back the memory of what traces here, between two batches.
    Result<Done> purge() {
        const std::lock_guard lock(local_mutex_);
        return local_.purge();
    }
    /// Lets rays fail that visit this rank from now on, and waits for those that are traced: the
    /// host is about to change the scene.
    void leave_soup() {
        const std::lock_guard lock(local_mutex_);
        has_left_soup_ = true;
    }

private:
    struct Batch;
    using Messages = std::span<const Received* const>;

    void run(const std::stop_token& stop) noexcept;
    void serve_until(const std::stop_token& stop);
    void serve_first(std::vector<Received>& waiting);
    void serve(std::span<const Received> all, MessageKind kind);
    template <class Answer, class Trace>
    void answer(Messages messages, MessageKind kind, Trace&& trace);
    void fail(Messages messages, const Error& error);

    Structure& local_;
    Transport& transport_;
    LoopThreads* const threads_;
    const std::unique_ptr<Batch> batch_; // under way
    std::mutex local_mutex_;
    bool has_left_soup_ = false; // behind the mutex
    std::atomic<bool> is_idle_{true};
    std::atomic<uint64_t> served_{0};
    std::jthread thread_; // ends first
};

} // namespace ovc
