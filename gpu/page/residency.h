// SPDX-License-Identifier: Apache-2.0
// Residency: decides which page lies where in a pool, and which pages go when room is needed. It
// makes no GL calls.
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

/// A pool's bytes in buffers: each has the max size, and the last holds the rest. A unit's number
/// has the buffer's number above the unit's number within the buffer.
struct PoolLayout {
    uint64_t bytes;
    uint64_t buffer_bytes; // the max of one buffer

    uint32_t count() const { return bytes == 0 ? 0 : uint32_t((bytes - 1) / buffer_bytes) + 1; }
    uint64_t bytes_of(uint32_t buffer) const {
        assert(buffer < count());
        return std::min(buffer_bytes, bytes - buffer * buffer_bytes);
    }
    /// The bits of a unit's number that count within its buffer.
    uint32_t buffer_bits() const {
        return count() <= 1 ? OVC_MAX_BUFFER_BITS
                            : uint32_t(std::bit_width(buffer_bytes / OVC_UNIT_BYTES - 1));
    }
    /// Returns the offset of the buffer's first byte in a pool in which every buffer had as many
    /// units as buffer_bits() can number.
    uint64_t begin_of(uint32_t buffer) const {
        return (uint64_t(buffer) << buffer_bits()) * OVC_UNIT_BYTES;
    }
    uint32_t buffer_of(uint64_t offset) const {
        return uint32_t(offset / OVC_UNIT_BYTES >> buffer_bits());
    }
};

/// How many pages, the first of those whose sizes are given, find room one after the other behind
/// the first `begin` bytes, and the bytes of the pool that they need.
struct Fit {
    size_t pages;
    uint64_t pool_bytes;
};
Fit fit_in(std::span<const uint64_t> page_bytes, const PoolLayout& layout, uint64_t begin);

std::vector<uint64_t> bytes_of_each(std::span<const Page> pages);

inline bool all_fit(std::span<const Page> pages, const PoolLayout& layout, uint64_t begin) {
    return fit_in(bytes_of_each(pages), layout, begin).pages == pages.size();
}

/// A page's place in the pool, with the offset as PoolLayout::begin_of() counts.
struct Slot {
    uint64_t offset;
    uint64_t bytes;
};

/// A stretch of the pool.
struct Stretch {
    uint64_t begin;
    uint64_t end;
};

/// Returns the stretch of each buffer, without the first `begin` bytes of the pool.
std::vector<Stretch> stretches_of(const PoolLayout& layout, uint64_t begin);

/// The places of resident pages, by leaf, and their order of use.
class Residency {
public:
    /// Each page lies within one of the stretches. alignment: of offsets, in bytes.
    Residency(std::span<const Stretch> stretches, uint64_t alignment, size_t leaves);

    bool resident(uint32_t leaf) const { return slot(leaf).bytes != 0; }
    size_t resident_count() const { return resident_count_; }
    const Slot& slot(uint32_t leaf) const {
        assert(leaf < slots_.size());
        return slots_[leaf];
    }

    /// Marks the leaf as used now.
    void touch(uint32_t leaf) { last_use_[leaf] = ++clock_; }

    /// Returns a time that is later than every use so far.
    uint64_t now() const { return clock_ + 1; }

    /// Gives pages new numbers, which keep their places. was: for each number from now on the one
    /// before, or kNone for a page that is new. Those that are not in it go.
    void renumber(std::span<const uint32_t> was);

    /// Takes a resident page out.
    void evict(uint32_t leaf);

    /// Finds room for the leaf's page, which must fit some stretch, and evicts the least recently
    /// used pages that together with the gaps between them make enough room. Returns false and
    /// changes nothing if that would take a page that was used at `keep` or later. evicted:
    /// receives the leaves whose pages went.
    bool admit(uint32_t leaf, uint64_t bytes, uint64_t keep, std::vector<uint32_t>& evicted);

private:
    /// A stretch, and the leaves whose pages lie in it, by offset.
    struct Shelf {
        Stretch room;
        std::vector<uint32_t> leaves;
    };
    struct Range {
        size_t shelf;
        size_t first; // of its leaves, [first, last): their pages go
        size_t last;
        uint64_t offset;
        uint64_t use; // the latest use of these pages; 0: none goes
    };
    void find_cheaper(size_t shelf, uint64_t bytes, Range& best) const;

    std::vector<Shelf> shelves_;
    uint64_t alignment_;
    uint64_t clock_ = 0;
    std::vector<Slot> slots_;
    std::vector<uint64_t> last_use_;
    size_t resident_count_ = 0;
};

} // namespace ovc
