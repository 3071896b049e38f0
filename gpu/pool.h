// SPDX-License-Identifier: Apache-2.0
// Pool: the fixed number of GPU bytes that pages live in. One buffer, allocated once, filled by
// sub-buffer updates.
#pragma once

#include "gpu/gl_object.h"
#include "gpu/page.h"

#include <cstdint>
#include <vector>

namespace ovc {

/// Where a page lies in the pool.
struct Slot {
    uint64_t offset;
    uint64_t bytes;
};

/// Book-keeping of the pool, apart from GL: which leaf's page lies where, and which go when room is
/// needed.
class Residency {
public:
    /// Pages lie in [begin, end) of the pool, in bytes.
    Residency(uint64_t end, uint64_t alignment, size_t leaves, uint64_t begin = 0);

    bool resident(uint32_t leaf) const { return slots_[leaf].bytes != 0; }
    const Slot& slot(uint32_t leaf) const { return slots_[leaf]; }

    /// Marks the leaf as used now.
    void touch(uint32_t leaf) { last_use_[leaf] = ++clock_; }

    /// Every use so far is before what this returns.
    uint64_t now() const { return clock_ + 1; }

    /// Finds room for the leaf's page, which must fit the pool, and evicts what has to go: the
    /// least recently used pages that together with the gaps between them make enough room. Pages
    /// used at `keep` or later stay: false, and nothing changes, where that leaves no room.
    /// evicted: receives who went.
    bool admit(uint32_t leaf, uint64_t bytes, uint64_t keep, std::vector<uint32_t>& evicted);

private:
    struct Range {
        size_t first; // into order_: pages to evict
        size_t last;
        uint64_t offset;
        uint64_t use; // the latest of them; 0: none goes
    };
    Range cheapest_range(uint64_t bytes) const;

    uint64_t begin_;
    uint64_t end_;
    uint64_t alignment_;
    uint64_t clock_ = 0;
    std::vector<Slot> slots_;
    std::vector<uint64_t> last_use_;
    std::vector<uint32_t> order_; // resident leaves by offset
};

/// The buffer and its books. Needs the context current.
class Pool {
public:
    /// Pages come behind the first `begin` bytes.
    Pool(Ledger& ledger, uint64_t bytes, size_t leaves, uint64_t begin = 0)
        : buffer_(ledger, bytes, "page pool"), residency_(bytes, OVC_UNIT_BYTES, leaves, begin) {}

    Residency& residency() { return residency_; }
    const Residency& residency() const { return residency_; }

    /// Writes the page at `offset`, in bytes, its units counted from `first_unit` on.
    void upload(uint64_t offset, const Page& page, uint32_t first_unit = 0) const;

    const gl::Buffer& buffer() const { return buffer_; }

private:
    gl::Buffer buffer_;
    Residency residency_;
};

} // namespace ovc
