// SPDX-License-Identifier: Apache-2.0
// Blocks: an array that grows without ever holding its contents twice.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace ovc {

/// Append, then take() it as one vector of exactly that capacity. Nothing is copied where reserve()
/// was told enough.
template <class T>
class Blocks {
public:
    void reserve(size_t count) {
        if (blocks_.empty() && count > 0)
            add_block(count);
    }

    void push_back(const T& value) {
        if (blocks_.empty() || blocks_.back().size() == blocks_.back().capacity())
            add_block(std::clamp(size_, kSmallest, kLargest));
        blocks_.back().push_back(value);
        ++size_;
    }

    size_t size() const { return size_; }

    std::vector<T> take() {
        if (blocks_.size() == 1 && blocks_[0].capacity() == size_)
            return std::move(blocks_[0]);
        std::vector<T> whole;
        whole.reserve(size_);
        for (std::vector<T>& block : blocks_) {
            whole.insert(whole.end(), block.begin(), block.end());
            block = {};
        }
        blocks_.clear();
        return whole;
    }

private:
    static constexpr size_t kSmallest = 96;
    // glibc maps what is 32 MiB or more on its own, so that freeing it in take() gives it back at
    // once.
    static constexpr size_t kLargest = (size_t(33) << 20) / sizeof(T);

    void add_block(size_t capacity) {
        blocks_.emplace_back();
        blocks_.back().reserve(capacity);
    }

    std::vector<std::vector<T>> blocks_;
    size_t size_ = 0;
};

} // namespace ovc
