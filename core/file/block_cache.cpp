// SPDX-License-Identifier: Apache-2.0
// BlockCache: neighbouring blocks lie in neighbouring sets, each of which has a lock.
#include "core/file/block_cache.h"

#include <sys/mman.h>

#include <algorithm>
#include <cassert>
#include <cstring>
#include <new>

namespace ovc {

BlockCache::BlockCache(uint64_t block_bytes, uint64_t capacity_bytes)
    : block_bytes_(block_bytes),
      sets_(std::max<size_t>(kMinSets, capacity_bytes / (kWays * block_bytes))) {
    void* const mapped = mmap(nullptr, sets_.size() * kWays * block_bytes, PROT_READ | PROT_WRITE,
                              MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (mapped == MAP_FAILED)
        throw std::bad_alloc();
    memory_ = static_cast<std::byte*>(mapped);
}

BlockCache::~BlockCache() {
    munmap(memory_, sets_.size() * kWays * block_bytes_);
}

bool BlockCache::copy(uint64_t block, size_t offset, std::span<std::byte> to,
                      FunctionRef<bool(std::span<std::byte>)> fill) {
    assert(block != kEmpty && offset + to.size() <= block_bytes_);
    const size_t number = block % sets_.size();
    Set& set = sets_[number];
    const std::lock_guard lock(set.mutex);
    auto way = size_t(std::ranges::find(set.blocks, block) - set.blocks.begin());
    const bool is_here = way < kWays;
    (is_here ? hits_ : misses_).fetch_add(1, std::memory_order_relaxed);
    if (!is_here)
        way = size_t(std::ranges::min_element(set.last_use) - set.last_use.begin());
    std::byte* const place = memory_ + (number * kWays + way) * block_bytes_;
    if (!is_here) {
        if (set.last_use[way] == 0) {
            set.last_use[way] = 1;
            ++used_;
        }
        set.blocks[way] = kEmpty;
        if (!fill({place, block_bytes_}))
            return false;
        set.blocks[way] = block;
    }
    if (++set.clock == 0) { // it has wrapped around
        set.last_use.fill(1);
        set.clock = 2;
    }
    set.last_use[way] = set.clock;
    std::memcpy(to.data(), place + offset, to.size());
    return true;
}

} // namespace ovc
