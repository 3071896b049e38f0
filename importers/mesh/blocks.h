// SPDX-License-Identifier: Apache-2.0
// Blocks is an array that grows without ever holding its contents twice.
#pragma once

#include "core/system/system_pages.h"

#include <cassert>
#include <cstddef>
#include <cstring>
#include <type_traits>
#include <utility>
#include <vector>

namespace ovc {

/// Append items, then take() them as one vector without spare capacity. Nothing is copied if
/// reserve() was told the size; else at most kBlock items exist twice.
template <class T>
class Blocks {
    static_assert(std::is_trivially_copyable_v<T>);

public:
    /// Reserved memory that is never used costs nothing: the system finds pages on first touch.
    void reserve(size_t count) { first_.reserve(count); }

    void push_back(const T& value) {
        if (first_.size() < first_.capacity() || first_.size() < kBlock)
            first_.push_back(value);
        else
            push_later(value);
    }

    size_t size() const {
        return first_.size() + (later_.empty() ? 0 : (later_.size() - 1) * kBlock + used_);
    }

    /// Returns all items and leaves none behind.
    std::vector<T> take() {
        if (first_.capacity() == size()) {
            assert(later_.empty());
            return std::move(first_);
        }
        std::vector<T> whole;
        whole.reserve(size());
        whole.insert(whole.end(), first_.begin(), first_.end());
        first_ = {};
        for (size_t i = 0; i < later_.size(); ++i) {
            const T* items = static_cast<const T*>(later_[i].get());
            whole.insert(whole.end(), items, items + (i + 1 < later_.size() ? kBlock : used_));
            later_[i].reset();
        }
        later_.clear();
        return whole;
    }

private:
    static constexpr size_t kBlock = (size_t(1) << 18) / sizeof(T);

    void push_later(const T& value) {
        if (used_ == kBlock || later_.empty()) {
            later_.push_back(map_pages(kBlock * sizeof(T)));
            used_ = 0;
        }
        assert(used_ < kBlock);
        std::memcpy(static_cast<T*>(later_.back().get()) + used_++, &value, sizeof(T));
    }

    std::vector<T> first_;
    std::vector<SystemPages> later_; // of kBlock items each
    size_t used_ = 0;                // items in the last of them
};

} // namespace ovc
