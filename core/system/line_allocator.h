// SPDX-License-Identifier: Apache-2.0
// LineAllocator: memory that begins at a cache line.
#pragma once

#include <cstddef>
#include <new>

namespace ovc {

/// An item as large as a line, or a part of it, then never lies in two.
template <class T>
struct LineAllocator {
    using value_type = T;
    static constexpr std::align_val_t kLine{64};

    LineAllocator() = default;
    template <class Other>
    LineAllocator(const LineAllocator<Other>&) {}
    T* allocate(size_t count) { return static_cast<T*>(::operator new(count * sizeof(T), kLine)); }
    /// Clang before version 19 has no operator delete that takes a size, unless it is asked to.
    void deallocate(T* all, size_t) { ::operator delete(all, kLine); }
    bool operator==(const LineAllocator&) const = default;
};

} // namespace ovc
