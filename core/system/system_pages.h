// SPDX-License-Identifier: Apache-2.0
// Pages of memory straight from the system.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace ovc {

/// Gives the pages back, and they leave the process at once. malloc may keep what it gets back.
struct UnmapPages {
    size_t bytes = 0;

    void operator()(void* pages) const;
};
using SystemPages = std::unique_ptr<void, UnmapPages>;

/// Returns zeroed memory that begins at a page. The system finds pages on first touch, so memory
/// that is never used costs nothing. Throws std::bad_alloc.
SystemPages map_pages(size_t bytes);

/// Allocates whole pages, as map_pages() does.
template <class T>
struct PageAllocator {
    using value_type = T;

    PageAllocator() = default;
    template <class Other>
    PageAllocator(const PageAllocator<Other>&) {}
    T* allocate(size_t count) { return static_cast<T*>(map_pages(count * sizeof(T)).release()); }
    void deallocate(T* pages, size_t count) { UnmapPages{count * sizeof(T)}(pages); }
    bool operator==(const PageAllocator&) const = default;
};
/// Its elements begin at a page, and a device may read whole pages of them.
template <class T>
using PagedVector = std::vector<T, PageAllocator<T>>;

} // namespace ovc
