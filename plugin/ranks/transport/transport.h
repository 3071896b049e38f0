// SPDX-License-Identifier: Apache-2.0
// Transport: carries messages between ranks. MPI does so for processes (mpi_transport.h), memory
// for tests.
#pragma once

#include "core/result.h"
#include "plugin/ranks/transport/message.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ovc {

/// A message, and the rank that sent it.
struct Received {
    uint32_t from;
    Message message;
};

/// Messages that have come and wait for a thread to take them.
class MessageQueue {
public:
    void put(uint32_t from, Message message) {
        {
            const std::lock_guard lock(mutex_);
            received_.push_back({from, std::move(message)});
        }
        changed_.notify_one();
    }
    /// Wakes the thread that waits.
    void wake() { changed_.notify_all(); }
    /// Takes all messages; waits for the first for so long at most.
    std::vector<Received> take(std::chrono::milliseconds patience) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, patience, [&] { return !received_.empty(); });
        return std::exchange(received_, {});
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Received> received_;
};

/// Counts of what the transport has done.
struct TransportCounts {
    uint64_t bytes_sent = 0;
    uint64_t bytes_received = 0;
};

class Transport {
public:
    virtual ~Transport() = default;

    virtual uint32_t rank() const = 0;
    virtual uint32_t ranks() const = 0;
    /// Returns how people call a rank: "rank 3 on node7".
    virtual std::string name_of(uint32_t rank) const = 0;

    /// Sends a message to a rank, this one or another, and does not wait for it. Messages to one
    /// rank arrive in the order in which they were sent. Any thread.
    void send(uint32_t to, Message message) {
        if (to == rank())
            deliver(to, std::move(message));
        else
            send_away(to, std::move(message));
    }
    /// The queues in which messages arrive.
    MessageQueue visits, answers, notes;

    /// Returns what has happened to a rank that is gone, this one or another; nothing while all are
    /// there.
    virtual std::optional<Error> lost() const = 0;
    /// Gives this rank up, which cannot work for the others any more: lost() returns the error
    /// here, and there it tells that this rank is lost. Any thread.
    virtual void give_up(Error why) noexcept = 0;
    /// Waits until all ranks have called this, or one is lost. Messages come in until then, and no
    /// longer.
    virtual void close() = 0;
    virtual TransportCounts counts() const = 0;

protected:
    virtual void send_away(uint32_t to, Message message) = 0;
    void deliver(uint32_t from, Message message) {
        MessageQueue& queue = message.has_visits()                  ? visits
                              : message.kind() == MessageKind::Note ? notes
                                                                    : answers;
        queue.put(from, std::move(message));
    }
};

} // namespace ovc
