// SPDX-License-Identifier: Apache-2.0
// Pool: eviction by least recent use among neighbours, upload.
#include "gpu/pool.h"

#include "gpu/top_level.h"

#include <algorithm>
#include <cassert>
#include <limits>

namespace ovc {

Residency::Residency(uint64_t end, uint64_t alignment, size_t leaves, uint64_t begin)
    : begin_((begin + alignment - 1) / alignment * alignment),
      end_(end),
      alignment_(alignment),
      slots_(leaves, Slot{0, 0}),
      last_use_(leaves, 0) {}

/// A run of neighbouring pages and the gaps around them that is wide enough. Of all such runs the
/// one whose most recently used page was used longest ago; a gap that is wide enough by itself
/// evicts nobody.
Residency::Range Residency::cheapest_range(uint64_t bytes) const {
    const auto gap_begin = [&](size_t i) {
        return i == 0 ? begin_ : slots_[order_[i - 1]].offset + slots_[order_[i - 1]].bytes;
    };
    const auto gap_end = [&](size_t i) {
        return i == order_.size() ? end_ : slots_[order_[i]].offset;
    };
    Range best{0, 0, 0, std::numeric_limits<uint64_t>::max()};
    for (size_t first = 0; first <= order_.size(); ++first) {
        const uint64_t begin = gap_begin(first);
        uint64_t use = 0;
        for (size_t last = first; last <= order_.size(); ++last) {
            if (last > first)
                use = std::max(use, last_use_[order_[last - 1]]);
            if (use >= best.use)
                break;
            if (gap_end(last) - begin >= bytes) {
                best = {first, last, begin, use};
                break;
            }
        }
    }
    return best;
}

bool Residency::admit(uint32_t leaf, uint64_t bytes, uint64_t keep,
                      std::vector<uint32_t>& evicted) {
    assert(!resident(leaf));
    bytes = (bytes + alignment_ - 1) / alignment_ * alignment_;
    assert(bytes <= end_ - begin_);
    const Range range = cheapest_range(bytes);
    if (range.use >= keep)
        return false;
    for (size_t i = range.first; i < range.last; ++i) {
        slots_[order_[i]] = {0, 0};
        evicted.push_back(order_[i]);
    }
    const auto at = order_.erase(order_.begin() + ptrdiff_t(range.first),
                                 order_.begin() + ptrdiff_t(range.last));
    order_.insert(at, leaf);
    slots_[leaf] = {range.offset, bytes};
    touch(leaf);
    return true;
}

void Pool::upload(uint64_t offset, const Page& page, uint32_t first_unit) const {
    if (page.bytes() == 0)
        return;
    void* const to = glMapNamedBufferRange(buffer_.id(), GLintptr(offset), GLsizeiptr(page.bytes()),
                                           GL_MAP_WRITE_BIT | GL_MAP_INVALIDATE_RANGE_BIT);
    if (!to)
        return; // the context is lost, which is asked for after every pass
    copy_relocated(page, first_unit, {static_cast<uvec4*>(to), page.view().size()});
    glUnmapNamedBuffer(buffer_.id());
}

} // namespace ovc
