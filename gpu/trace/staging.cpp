// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/staging.h"

#include <cassert>

namespace ovc {

static constexpr size_t kAlignment = 64; // bytes: a cache line, and a unit of a page

StagingRing::~StagingRing() {
    if (!flights_.empty())
        driver_.wait(flights_.back().fence); // the driver may still read the memory
}

/// Waits for the flights that lie there. Those before them are over as well then.
void StagingRing::make_room(size_t begin, size_t end) {
    size_t over = 0;
    for (size_t i = 0; i < flights_.size(); ++i)
        if (flights_[i].begin < end && begin < flights_[i].end)
            over = i + 1;
    if (over == 0)
        return;
    driver_.wait(flights_[over - 1].fence);
    flights_.erase(flights_.begin(), flights_.begin() + ptrdiff_t(over));
}

void StagingRing::write(size_t bytes, uint32_t buffer, uint64_t to,
                        FunctionRef<void(std::span<std::byte>)> fill) {
    assert(bytes > 0 && bytes <= max_bytes());
    const std::span<std::byte> memory = driver_.memory();
    const size_t begin = next_ + bytes <= memory.size() ? next_ : 0;
    make_room(begin, begin + bytes);
    fill(memory.subspan(begin, bytes));
    driver_.copy(begin, bytes, buffer, to);
    flights_.push_back({begin, begin + bytes, driver_.fence()});
    next_ = (begin + bytes + kAlignment - 1) / kAlignment * kAlignment;
}

} // namespace ovc
