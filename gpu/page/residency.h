// SPDX-License-Identifier: Apache-2.0
// Which page lies where in a pool, and which go when room is needed; apart from GL.
#pragma once

#include "gpu/page/page.h"
#include "shaders/layout.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>
#include <span>
#include <vector>

namespace ovc {

/// A pool's bytes in buffers: each as large as one may be, and the last has what is left. A unit's
/// number has the buffer's above its number within that.
struct PoolLayout {
    uint64_t bytes;
    uint64_t buffer_bytes; // the most of one

    uint32_t count() const { return bytes == 0 ? 0 : uint32_t((bytes - 1) / buffer_bytes) + 1; }
    uint64_t bytes_of(uint32_t buffer) const {
        assert(buffer < count());
        return std::min(buffer_bytes, bytes - buffer * buffer_bytes);
    }
    /// Of the number of a unit, those that count within its buffer.
    uint32_t buffer_bits() const {
        return count() <= 1 ? OVC_MAX_BUFFER_BITS
                            : uint32_t(std::bit_width(buffer_bytes / OVC_UNIT_BYTES - 1));
    }
    /// The buffer's first byte among those of a pool whose buffers could be filled to the last
    /// number that a unit of them can have.
    uint64_t begin_of(uint32_t buffer) const {
        return (uint64_t(buffer) << buffer_bits()) * OVC_UNIT_BYTES;
    }
    uint32_t buffer_of(uint64_t offset) const {
        return uint32_t(offset / OVC_UNIT_BYTES >> buffer_bits());
    }
};

/// How many pages, the first of those of so many bytes, find room one after the other behind the
/// first `begin` bytes; and how many bytes of the pool that takes.
struct Fit {
    size_t pages;
    uint64_t pool_bytes;
};
Fit fit_in(std::span<const uint64_t> page_bytes, const PoolLayout& layout, uint64_t begin);

std::vector<uint64_t> bytes_of_each(std::span<const Page> pages);

inline bool all_fit(std::span<const Page> pages, const PoolLayout& layout, uint64_t begin) {
    return fit_in(bytes_of_each(pages), layout, begin).pages == pages.size();
}

/// Where a page lies in the pool, as PoolLayout::begin_of() counts.
struct Slot {
    uint64_t offset;
    uint64_t bytes;
};

/// A stretch of the pool.
struct Stretch {
    uint64_t begin;
    uint64_t end;
};

/// What each buffer holds behind the first `begin` bytes of the pool.
std::vector<Stretch> stretches_of(const PoolLayout& layout, uint64_t begin);

/// Which leaf's page lies where, and which go when room is needed.
class Residency {
public:
    /// Pages lie within one of the stretches each, in bytes.
    Residency(std::span<const Stretch> stretches, uint64_t alignment, size_t leaves);

    bool resident(uint32_t leaf) const { return slot(leaf).bytes != 0; }
    const Slot& slot(uint32_t leaf) const {
        assert(leaf < slots_.size());
        return slots_[leaf];
    }

    /// Marks the leaf as used now.
    void touch(uint32_t leaf) { last_use_[leaf] = ++clock_; }

    /// Every use so far is before what this returns.
    uint64_t now() const { return clock_ + 1; }

    /// Finds room for the leaf's page, which must fit some stretch, and evicts what has to go: the
    /// least recently used pages that together with the gaps between them make enough room. Pages
    /// used at `keep` or later stay: false, and nothing changes, where that leaves no room.
    /// evicted: receives who went.
    bool admit(uint32_t leaf, uint64_t bytes, uint64_t keep, std::vector<uint32_t>& evicted);

private:
    /// A stretch, and the leaves whose pages lie in it, by offset.
    struct Shelf {
        Stretch room;
        std::vector<uint32_t> leaves;
    };
    struct Range {
        size_t shelf;
        size_t first; // into its leaves: pages to evict
        size_t last;
        uint64_t offset;
        uint64_t use; // the latest of them; 0: none goes
    };
    void find_cheaper(size_t shelf, uint64_t bytes, Range& best) const;

    std::vector<Shelf> shelves_;
    uint64_t alignment_;
    uint64_t clock_ = 0;
    std::vector<Slot> slots_;
    std::vector<uint64_t> last_use_;
};

} // namespace ovc
