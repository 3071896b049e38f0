// SPDX-License-Identifier: Apache-2.0
// TurnOrder: workers do something one at a time, each when its turn comes round or as they come.
// Turn (core/system/turn.h) is for threads that have no numbers, and may give up.
#pragma once

#include <condition_variable>
#include <cstddef>
#include <mutex>
#include <vector>

namespace ovc {

class TurnOrder {
public:
    /// Workers have the numbers below `workers`. in_order: each waits until the one before it has
    /// had its turn, so that what they do is in the same order in every run.
    TurnOrder(size_t workers, bool in_order) : in_order_(in_order), takes_part_(workers, true) {}

    /// Waits for the worker's turn, calls act() and returns what that does.
    template <class Act>
    auto take(size_t worker, Act&& act) {
        const Turn turn(*this, worker);
        return act();
    }

    /// The worker takes no turn any more, and no other waits for it.
    void leave(size_t worker) {
        const std::lock_guard lock(mutex_);
        takes_part_[worker] = false;
        if (next_ == worker)
            find_next();
    }
    /// The worker leaves when this is destroyed.
    class Seat {
    public:
        Seat(TurnOrder& order, size_t worker) : order_(order), worker_(worker) {}
        ~Seat() { order_.leave(worker_); }
        Seat(const Seat&) = delete;

    private:
        TurnOrder& order_;
        const size_t worker_;
    };

private:
    struct Turn {
        Turn(TurnOrder& all, size_t worker) : order(all) { order.begin(worker); }
        ~Turn() { order.end(); }
        TurnOrder& order;
    };

    void begin(size_t worker) {
        std::unique_lock lock(mutex_);
        changed_.wait(lock, [&] { return !taken_ && (!in_order_ || next_ == worker); });
        taken_ = true;
    }
    void end() {
        const std::lock_guard lock(mutex_);
        taken_ = false;
        find_next();
    }
    /// Makes it the turn of the next worker that takes part.
    void find_next() {
        for (size_t i = 0; i < takes_part_.size(); ++i) {
            next_ = (next_ + 1) % takes_part_.size();
            if (takes_part_[next_])
                break;
        }
        changed_.notify_all();
    }

    const bool in_order_;
    std::mutex mutex_; // guards the members below
    std::condition_variable changed_;
    std::vector<bool> takes_part_;
    size_t next_ = 0; // whose turn it is, in order
    bool taken_ = false;
};

} // namespace ovc
