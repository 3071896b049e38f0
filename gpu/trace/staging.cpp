// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/staging.h"

#include <cassert>

namespace ovc {

static constexpr size_t kAlignment = 64; // bytes: a cache line, and a unit of a page

StagingRing::~StagingRing() {
    if (!pending_.empty())
        driver_.wait(pending_.back().fence); // the driver may still read the memory
}

/// Waits for the copies from there. Those before them are over as well then.
void StagingRing::make_room(size_t begin, size_t end) {
    size_t over = 0;
    for (size_t i = 0; i < pending_.size(); ++i)
        if (pending_[i].begin < end && begin < pending_[i].end)
            over = i + 1;
    if (over == 0)
        return;
    driver_.wait(pending_[over - 1].fence);
    pending_.erase(pending_.begin(), pending_.begin() + ptrdiff_t(over));
}

void StagingRing::write(size_t bytes, uint32_t buffer, uint64_t to,
                        FunctionRef<void(std::span<std::byte>)> fill) {
    assert(bytes > 0 && bytes <= max_bytes());
    const std::span<std::byte> memory = driver_.memory();
    const size_t begin = next_ + bytes <= memory.size() ? next_ : 0;
    make_room(begin, begin + bytes);
    fill(memory.subspan(begin, bytes));
    driver_.copy(begin, bytes, buffer, to);
    pending_.push_back({begin, begin + bytes, driver_.fence()});
    next_ = (begin + bytes + kAlignment - 1) / kAlignment * kAlignment;
}

} // namespace ovc
