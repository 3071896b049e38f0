// SPDX-License-Identifier: Apache-2.0
// SharedBudget: the bytes that all scenes of a device may use on it together. Every scene has a
// share; where the budget holds less than all of them need, those that have not been used for
// longest give theirs back until they are used again.
#pragma once

#include "core/result.h"
#include "core/system/turn.h"

#include <condition_variable>
#include <cstdint>
#include <functional>
#include <mutex>
#include <set>
#include <thread>
#include <utility>
#include <vector>

namespace ovc {

class SharedBudget {
public:
    class Share;

    /// bytes: 0 for no limit.
    explicit SharedBudget(uint64_t bytes) : bytes_(bytes) {}
    SharedBudget(const SharedBudget&) = delete;

    uint64_t bytes() const { return bytes_; }

    /// While it lives, this thread waits for what another thread has. It may be within a Use.
    class Waiting {
    public:
        explicit Waiting(SharedBudget& budget, Share* wanted = nullptr);
        ~Waiting();
        Waiting(const Waiting&) = delete;

        /// Whether the other thread waits for room that only this one, and threads that wait as it
        /// does, could give back.
        bool is_in_vain(std::thread::id other) const;

    private:
        SharedBudget& budget_;
        Share* const wanted_;
    };

    /// The time within which a share may be used. Nobody takes it away meanwhile.
    class Use {
    public:
        Use() = default; // of nothing
        Use(Use&& other) noexcept : share_(std::exchange(other.share_, nullptr)) {}
        Use& operator=(Use&&) = delete;
        ~Use();

    private:
        friend class Share;
        explicit Use(Share& share) : share_(&share) {}
        Share* share_ = nullptr;
    };

    /// The part that one scene may use. Calls on one share come from one thread at a time.
    class Share {
    public:
        /// close(): frees what was allocated under the share; on any thread, but never within a Use
        /// of it. The budget must outlive the share.
        Share(SharedBudget& budget, std::function<void()> close);
        /// Closes it.
        ~Share();
        Share(const Share&) = delete;

        /// Sets the bytes that it works with (min, at most the budget's) and those that it has use
        /// for (max). Call it before the first begin(), and whenever that changes; a share that is
        /// open is closed for more only where that is worth it.
        void demand(uint64_t min, uint64_t max);

        /// Waits until the share can be used, first come, first served; others close where they
        /// must. bytes() tells what may be allocated from now on; where that has changed, the share
        /// is closed. goes_on(), which may throw, is asked now and then whether to wait on. Error
        /// of the kind Cancelled: it returned false; OverBudget: this thread itself is within uses
        /// of others that leave too little.
        Result<Use> begin(const std::function<bool()>& goes_on);

        /// Frees what was allocated, outside of a Use.
        void close();

        uint64_t bytes() const { return bytes_; }
        uint64_t max_bytes() const { return max_; }

    private:
        friend class SharedBudget;
        friend class Use;

        SharedBudget& budget_;
        const std::function<void()> close_;
        uint64_t min_ = 0, max_ = 0;
        uint64_t bytes_ = 0;     // granted; 0: closed
        std::thread::id user_;   // the thread that is within a Use
        bool is_wanted_ = false; // a thread waits until it is granted
        uint64_t last_use_ = 0;  // a time
    };

private:
    uint64_t sum_at(uint64_t level) const;
    uint64_t fair_bytes(const Share& share) const;
    uint64_t free_bytes(const Share& share) const;
    bool make_room(const Share& share, uint64_t bytes);
    bool grant(Share& share);
    bool nobody_works() const;
    bool nobody_may_begin() const;
    bool is_inside(std::thread::id thread) const;
    static void close(Share& share);

    const uint64_t bytes_;
    Turn turn_;        // of those that begin
    std::mutex mutex_; // guards the members below, and all shares
    std::condition_variable changed_;
    std::vector<Share*> shares_;
    std::set<std::thread::id> waiting_; // threads that wait, in begin() or as a Waiting says
    uint64_t clock_ = 0;
};

} // namespace ovc
