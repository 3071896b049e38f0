// SPDX-License-Identifier: Apache-2.0
// Evicts neighbouring pages by least recent use.
#include "gpu/page/residency.h"

#include <cassert>
#include <limits>
#include <utility>

namespace ovc {
namespace {

uint64_t rounded_up(uint64_t bytes, uint64_t alignment) {
    return (bytes + alignment - 1) / alignment * alignment;
}

} // namespace

std::vector<Stretch> stretches_of(const PoolLayout& layout, uint64_t begin) {
    std::vector<Stretch> stretches;
    for (uint32_t i = 0; i < layout.count(); ++i)
        stretches.push_back(
            {layout.begin_of(i) + (i == 0 ? begin : 0), layout.begin_of(i) + layout.bytes_of(i)});
    return stretches;
}

std::vector<uint64_t> bytes_of_each(std::span<const Page> pages) {
    std::vector<uint64_t> bytes;
    for (const Page& page : pages)
        bytes.push_back(page.bytes());
    return bytes;
}

Fit fit_in(std::span<const uint64_t> page_bytes, const PoolLayout& layout, uint64_t begin) {
    std::vector<Stretch> free = stretches_of(layout, begin);
    Fit fit{0, std::min(begin, layout.bytes)};
    for (const uint64_t bytes : page_bytes) {
        const auto room =
            std::ranges::find_if(free, [&](const Stretch& s) { return s.begin + bytes <= s.end; });
        if (room == free.end())
            break;
        room->begin += bytes;
        const auto buffer = uint32_t(room - free.begin());
        fit.pool_bytes = std::max(fit.pool_bytes, buffer * layout.buffer_bytes + room->begin -
                                                      layout.begin_of(buffer));
        ++fit.pages;
    }
    return fit;
}

Residency::Residency(std::span<const Stretch> stretches, uint64_t alignment, size_t leaves)
    : alignment_(alignment), slots_(leaves, Slot{0, 0}), last_use_(leaves, 0) {
    for (const Stretch& stretch : stretches)
        shelves_.push_back({{rounded_up(stretch.begin, alignment), stretch.end}, {}});
}

/// Looks for a run of neighbouring pages that, with the gaps around them, is wide enough. It
/// chooses the run whose most recently used page was used longest ago; a gap that is wide enough by
/// itself evicts no page. Puts the run into `best` if it is cheaper.
void Residency::find_cheaper(size_t shelf, uint64_t bytes, Range& best) const {
    const auto& [room, leaves] = shelves_[shelf];
    const auto gap_begin = [&](size_t i) {
        return i == 0 ? room.begin : slots_[leaves[i - 1]].offset + slots_[leaves[i - 1]].bytes;
    };
    const auto gap_end = [&](size_t i) {
        return i == leaves.size() ? room.end : slots_[leaves[i]].offset;
    };
    for (size_t first = 0; first <= leaves.size() && best.use > 0; ++first) {
        const uint64_t begin = gap_begin(first);
        uint64_t use = 0;
        for (size_t last = first; last <= leaves.size(); ++last) {
            if (last > first)
                use = std::max(use, last_use_[leaves[last - 1]]);
            if (use >= best.use)
                break;
            if (begin + bytes <= gap_end(last)) {
                best = {shelf, first, last, begin, use};
                break;
            }
        }
    }
}

bool Residency::admit(uint32_t leaf, uint64_t bytes, uint64_t keep,
                      std::vector<uint32_t>& evicted) {
    assert(!resident(leaf));
    bytes = rounded_up(bytes, alignment_);
    assert(std::ranges::any_of(shelves_,
                               [&](const Shelf& s) { return s.room.begin + bytes <= s.room.end; }));
    Range range{0, 0, 0, 0, std::numeric_limits<uint64_t>::max()};
    for (size_t shelf = 0; shelf < shelves_.size(); ++shelf)
        find_cheaper(shelf, bytes, range);
    if (range.use >= keep)
        return false;
    assert(range.offset % alignment_ == 0);
    std::vector<uint32_t>& leaves = shelves_[range.shelf].leaves;
    for (size_t i = range.first; i < range.last; ++i) {
        slots_[leaves[i]] = {0, 0};
        evicted.push_back(leaves[i]);
        --resident_count_;
    }
    const auto at = leaves.erase(leaves.begin() + ptrdiff_t(range.first),
                                 leaves.begin() + ptrdiff_t(range.last));
    leaves.insert(at, leaf);
    slots_[leaf] = {range.offset, bytes};
    ++resident_count_;
    touch(leaf);
    return true;
}

void Residency::renumber(std::span<const uint32_t> was) {
    std::vector<Slot> slots(was.size(), Slot{0, 0});
    std::vector<uint64_t> last_use(was.size(), 0);
    std::vector<uint32_t> now(slots_.size(), kNone);
    resident_count_ = 0;
    for (uint32_t leaf = 0; leaf < was.size(); ++leaf) {
        if (was[leaf] == kNone)
            continue;
        assert(now[was[leaf]] == kNone);
        now[was[leaf]] = leaf;
        slots[leaf] = slots_[was[leaf]];
        last_use[leaf] = last_use_[was[leaf]];
        resident_count_ += slots[leaf].bytes != 0;
    }
    slots_ = std::move(slots);
    last_use_ = std::move(last_use);
    for (Shelf& shelf : shelves_) {
        for (uint32_t& leaf : shelf.leaves)
            leaf = now[leaf];
        std::erase(shelf.leaves, kNone);
    }
}

void Residency::evict(uint32_t leaf) {
    assert(resident(leaf));
    for (Shelf& shelf : shelves_)
        std::erase(shelf.leaves, leaf);
    slots_[leaf] = {0, 0};
    --resident_count_;
}

} // namespace ovc
