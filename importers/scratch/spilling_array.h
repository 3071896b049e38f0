// SPDX-License-Identifier: Apache-2.0
// SpillingArray lies in memory, or, where it may take so much of that alone, partly on a disk.
#pragma once

#include "importers/scratch/scratch_array.h"

#include <optional>
#include <vector>

namespace ovc {

/// Append items, and read them in any order. In memory they are one row, else pages, some of which
/// may be in a scratch file.
template <class T>
class SpillingArray {
public:
    SpillingArray() = default;
    /// Takes at most `bytes` of memory, about.
    SpillingArray(const std::filesystem::path& folder, uint64_t bytes) {
        paged_.emplace(folder, bytes);
    }

    size_t size() const { return paged_ ? paged_->size() : held_.size(); }
    bool empty() const { return size() == 0; }
    /// Returns how the disk failed first, which makes items arbitrary; null where it did not.
    const Error* error() const { return paged_ ? paged_->error() : nullptr; }

    void reserve(size_t items) {
        if (!paged_)
            held_.reserve(items);
    }
    void push_back(const T& value) {
        if (paged_)
            paged_->push_back(value);
        else
            held_.push_back(value);
    }
    T operator[](size_t i) { return paged_ ? (*paged_)[i] : held_[i]; }
    /// Gives all memory back.
    void clear() {
        if (paged_)
            paged_->clear();
        std::vector<T>().swap(held_);
    }

private:
    std::vector<T> held_;
    std::optional<ScratchArray<T>> paged_;
};

} // namespace ovc
