// SPDX-License-Identifier: Apache-2.0
// StagingRing: memory that this process writes and the driver copies from, used round and round. A
// place is written again once the driver has passed the fence behind the copy from it.
#pragma once

#include "core/function_ref.h"

#include <cstddef>
#include <cstdint>
#include <deque>
#include <span>

namespace ovc {

/// The ring asks this of a driver. Copies happen in the order in which they are asked for, at any
/// time until a fence behind them is passed.
class StagingDriver {
public:
    virtual ~StagingDriver() = default;
    /// The memory, which stays where it is; empty where the driver gives none.
    virtual std::span<std::byte> memory() = 0;
    /// Asks for a copy out of the memory. buffer, to: whose meaning the caller and the driver know.
    virtual void copy(size_t from, size_t bytes, uint32_t buffer, uint64_t to) = 0;
    /// Returns the number of a fence behind everything that was asked for. Numbers count up.
    virtual uint64_t fence() = 0;
    /// Returns once the driver has passed the fence.
    virtual void wait(uint64_t fence) = 0;
};

class StagingRing {
public:
    /// The driver outlives the ring.
    explicit StagingRing(StagingDriver& driver) : driver_(driver) {}
    ~StagingRing();
    StagingRing(const StagingRing&) = delete;

    /// The max bytes of one write: half of the memory, so that the next can be written while they
    /// are copied.
    size_t max_bytes() { return driver_.memory().size() / 2; }

    /// Calls fill(memory for so many bytes), and asks for a copy of them. Waits for the driver only
    /// where it has not yet copied what lies there. bytes: at most max_bytes().
    void write(size_t bytes, uint32_t buffer, uint64_t to,
               FunctionRef<void(std::span<std::byte>)> fill);

private:
    /// Bytes from `begin` to before `end` that the driver may still copy from.
    struct Pending {
        size_t begin;
        size_t end;
        uint64_t fence;
    };

    void make_room(size_t begin, size_t end);

    StagingDriver& driver_;
    std::deque<Pending> pending_; // the oldest first
    size_t next_ = 0;
};

} // namespace ovc
