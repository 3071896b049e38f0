// SPDX-License-Identifier: Apache-2.0
// Post: carries parcels between ranks. MPI does so for processes (mpi_post.h), memory for tests.
#pragma once

#include "core/result.h"
#include "plugin/ranks/parcel.h"

#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace ovc {

/// Parcels that have come and wait for a thread to take them.
class Inbox {
public:
    struct Letter {
        uint32_t from;
        Parcel parcel;
    };

    void put(uint32_t from, Parcel parcel) {
        {
            const std::lock_guard lock(mutex_);
            letters_.push_back({from, std::move(parcel)});
        }
        changed_.notify_one();
    }
    /// Wakes the thread that waits.
    void wake() { changed_.notify_all(); }
    /// Takes all letters; waits for the first for so long at most.
    std::vector<Letter> take(std::chrono::milliseconds patience) {
        std::unique_lock lock(mutex_);
        changed_.wait_for(lock, patience, [&] { return !letters_.empty(); });
        return std::exchange(letters_, {});
    }

private:
    std::mutex mutex_;
    std::condition_variable changed_;
    std::vector<Letter> letters_;
};

/// What the post has done.
struct PostCounts {
    uint64_t bytes_sent = 0;
    uint64_t bytes_received = 0;
};

class Post {
public:
    virtual ~Post() = default;

    virtual uint32_t rank() const = 0;
    virtual uint32_t ranks() const = 0;
    /// Returns how people call a rank: "rank 3 on node7".
    virtual std::string name_of(uint32_t rank) const = 0;

    /// Sends a parcel to a rank, this one or another, and does not wait for it. Parcels to one rank
    /// arrive in the order in which they were sent. Any thread.
    void send(uint32_t to, Parcel parcel) {
        if (to == rank())
            deliver(to, std::move(parcel));
        else
            send_away(to, std::move(parcel));
    }
    /// Where parcels arrive.
    Inbox visits, answers, notes;

    /// Returns what has happened to a rank that is gone; nothing while all are there.
    virtual std::optional<Error> lost() const = 0;
    /// Waits until all ranks have called this, or one is lost. Parcels come in until then, and no
    /// longer.
    virtual void close() = 0;
    virtual PostCounts counts() const = 0;

protected:
    virtual void send_away(uint32_t to, Parcel parcel) = 0;
    void deliver(uint32_t from, Parcel parcel) {
        Inbox& inbox = parcel.has_visits()                 ? visits
                       : parcel.kind() == ParcelKind::Note ? notes
                                                           : answers;
        inbox.put(from, std::move(parcel));
    }
};

} // namespace ovc
