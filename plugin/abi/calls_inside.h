// SPDX-License-Identifier: Apache-2.0
// CallsInside: counts the calls inside a handle, so that a thread can wait for them before it
// destroys the handle.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <functional>
#include <thread>

namespace ovc {

/// It counts in shards, so that many threads with short calls do not write to one cache line.
class CallsInside {
    struct alignas(64) Shard {
        std::atomic<int> inside{0};
    };

public:
    /// One call, from its first look at the handle to its last.
    class Call {
    public:
        explicit Call(CallsInside& all) : shard_(all.own_shard()) { ++shard_.inside; }
        ~Call() { --shard_.inside; }
        Call(const Call&) = delete;

    private:
        Shard& shard_;
    };

    bool none() const {
        return std::all_of(shards_.begin(), shards_.end(),
                           [](const Shard& shard) { return shard.inside == 0; });
    }
    /// Returns when no call is inside. The caller has closed the handle, so that later calls turn
    /// back at once.
    void wait_until_none() const {
        while (!none())
            std::this_thread::sleep_for(std::chrono::microseconds(100));
    }

private:
    Shard& own_shard() {
        const size_t hash = std::hash<std::thread::id>()(std::this_thread::get_id());
        return shards_[(hash * 0x9e3779b97f4a7c15u) >> 60];
    }

    std::array<Shard, 16> shards_;
};

} // namespace ovc
