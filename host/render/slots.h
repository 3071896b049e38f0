// SPDX-License-Identifier: Apache-2.0
// Slots hands out small numbers for as long as they are needed, and uses them again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

class Slots {
public:
    /// Returns `count` numbers that are free, all of them below end().
    std::vector<uint32_t> take(size_t count) {
        const size_t reused = std::min(count, free_.size());
        std::vector<uint32_t> taken(free_.end() - ptrdiff_t(reused), free_.end());
        free_.resize(free_.size() - reused);
        for (size_t i = reused; i < count; ++i)
            taken.push_back(end_++);
        return taken;
    }
    void give_back(uint32_t slot) { free_.push_back(slot); }

    /// The number behind the largest that was ever taken.
    uint32_t end() const { return end_; }
    size_t in_use() const { return end_ - free_.size(); }

private:
    uint32_t end_ = 0;
    std::vector<uint32_t> free_;
};

} // namespace ovc
