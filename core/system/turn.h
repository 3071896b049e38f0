// SPDX-License-Identifier: Apache-2.0
// Turn: a mutex whose waiters are served first come, first served, and may give up. std::mutex lets
// a thread that comes back at once overtake those that sleep, as long as it likes.
#pragma once

#include <cassert>
#include <chrono>
#include <condition_variable>
#include <cstdint>
#include <mutex>
#include <set>

namespace ovc {

class Turn {
public:
    void lock() {
        lock_while([] { return true; });
    }

    /// Waits for this thread's turn as long as goes_on(), which is asked some fifty times a second,
    /// returns true. Returns whether the thread has the turn; where goes_on() throws, it has not.
    template <class GoesOn>
    bool lock_while(GoesOn&& goes_on) {
        std::unique_lock lock(mutex_);
        const uint64_t mine = next_++;
        const auto is_mine = [&] { return served_ == mine; };
        while (!changed_.wait_for(lock, std::chrono::milliseconds(20), is_mine)) {
            bool waits = false;
            lock.unlock();
            try {
                waits = goes_on();
            } catch (...) {
                lock.lock();
                give_up(mine);
                throw;
            }
            lock.lock();
            if (!waits && !is_mine()) {
                give_up(mine);
                return false;
            }
        }
        return true;
    }

    bool try_lock() {
        const std::lock_guard lock(mutex_);
        if (served_ != next_)
            return false;
        ++next_;
        return true;
    }

    void unlock() {
        {
            const std::lock_guard lock(mutex_);
            serve_next();
        }
        changed_.notify_all();
    }

private:
    void serve_next() {
        assert(served_ != next_); // some thread has the turn
        do
            ++served_;
        while (given_up_.erase(served_) > 0);
    }
    void give_up(uint64_t number) {
        if (number != served_) {
            given_up_.insert(number);
            return;
        }
        serve_next();
        changed_.notify_all();
    }

    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    uint64_t next_ = 0;           // the number for the next thread that comes
    uint64_t served_ = 0;         // the number whose turn it is
    std::set<uint64_t> given_up_; // numbers that are still to be served
};

} // namespace ovc
