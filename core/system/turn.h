// SPDX-License-Identifier: Apache-2.0
// Turn: a mutex whose waiters are served first come, first served, and may give up. std::mutex lets
// a thread that comes back at once overtake those that sleep, as long as it likes.
#pragma once

#include <cassert>
#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>
#include <utility>

namespace ovc {

/// It takes no memory, so that a thread may give up where there is none.
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
        if (take())
            return true;
        Waiter mine;
        *std::exchange(end_, &mine.next) = &mine;
        const auto is_mine = [&] { return mine.has_turn; };
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
        return take();
    }

    /// Returns the thread that has the turn; no thread's id where none has.
    std::thread::id owner() const {
        const std::lock_guard lock(mutex_);
        return owner_;
    }

    void unlock() {
        {
            const std::lock_guard lock(mutex_);
            serve_next();
        }
        changed_.notify_all();
    }

private:
    /// A thread that waits, on whose stack it lies.
    struct Waiter {
        const std::thread::id thread = std::this_thread::get_id();
        Waiter* next = nullptr; // behind it
        bool has_turn = false;
    };

    bool take() {
        if (owner_ != std::thread::id())
            return false;
        owner_ = std::this_thread::get_id();
        return true;
    }
    void serve_next() {
        assert(owner_ != std::thread::id());
        owner_ = {};
        if (first_) {
            Waiter* const next = leave(&first_);
            owner_ = next->thread;
            next->has_turn = true;
        }
    }
    void give_up(Waiter& waiter) {
        if (waiter.has_turn) {
            serve_next();
            changed_.notify_all();
            return;
        }
        Waiter** at = &first_;
        while (*at != &waiter)
            at = &(*at)->next;
        leave(at);
    }
    /// Takes out the waiter that the link leads to, and returns it.
    Waiter* leave(Waiter** link) {
        Waiter* const leaves = *link;
        *link = leaves->next;
        if (end_ == &leaves->next)
            end_ = link;
        return leaves;
    }

    mutable std::mutex mutex_; // guards the members below, and all waiters
    std::condition_variable changed_;
    std::thread::id owner_;
    Waiter* first_ = nullptr; // none waits where nobody has the turn
    Waiter** end_ = &first_;  // where the next goes
};

} // namespace ovc
