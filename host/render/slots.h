// SPDX-License-Identifier: Apache-2.0
// Slots keeps items under small numbers while they are needed, and uses the numbers again.
#pragma once

#include <cassert>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace ovc {

template <class T>
class Slots {
public:
    /// Returns the numbers of `count` free slots, whose contents are unspecified.
    std::vector<uint32_t> take(size_t count) {
        const size_t reused = std::min(count, free_.size());
        std::vector<uint32_t> taken(free_.end() - ptrdiff_t(reused), free_.end());
        free_.resize(free_.size() - reused);
        for (size_t i = reused; i < count; ++i)
            taken.push_back(uint32_t(items_.size() + i - reused));
        items_.resize(items_.size() + count - reused);
        return taken;
    }
    void give_back(uint32_t slot) { free_.push_back(slot); }

    T& operator[](uint32_t slot) {
        assert(slot < items_.size());
        return items_[slot];
    }
    size_t in_use() const { return items_.size() - free_.size(); }

private:
    std::vector<T> items_;
    std::vector<uint32_t> free_;
};

} // namespace ovc
