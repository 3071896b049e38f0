// SPDX-License-Identifier: Apache-2.0
// BlockCache: blocks of a file that were read lately, within a fixed number of bytes.
#pragma once

#include "core/function_ref.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <span>
#include <vector>

namespace ovc {

/// A block lies in one of a few places, which its number tells. Memory is taken as it is used, and
/// given back when the cache is destroyed.
class BlockCache {
public:
    /// capacity_bytes: the max of all blocks; less than a few blocks are taken for a few.
    BlockCache(uint64_t block_bytes, uint64_t capacity_bytes);
    ~BlockCache();
    BlockCache(const BlockCache&) = delete;

    /// Returns the smallest capacity that works.
    static uint64_t min_bytes(uint64_t block_bytes) { return kWays * kMinSets * block_bytes; }

    /// Copies bytes from `offset` on out of a block, which fill(whole block) -> bool reads where it
    /// is not here. Returns false where that does. Any number of threads may call this.
    bool copy(uint64_t block, size_t offset, std::span<std::byte> to,
              FunctionRef<bool(std::span<std::byte>)> fill);

    uint64_t hits() const { return hits_; }
    uint64_t misses() const { return misses_; }
    uint64_t bytes() const { return used_ * block_bytes_; }

private:
    static constexpr size_t kWays = 8;
    static constexpr size_t kMinSets = 4;
    static constexpr uint64_t kEmpty = ~uint64_t(0);

    struct Set {
        Set() { blocks.fill(kEmpty); }

        std::mutex mutex;
        std::array<uint64_t, kWays> blocks;
        std::array<uint32_t, kWays> last_use{};
        uint32_t clock = 0;
    };

    const uint64_t block_bytes_;
    std::vector<Set> sets_;
    std::byte* memory_ = nullptr;
    std::atomic<uint64_t> hits_{0}, misses_{0};
    std::atomic<uint64_t> used_{0}; // places that have been filled
};

} // namespace ovc
