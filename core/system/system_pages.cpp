// SPDX-License-Identifier: Apache-2.0
// SystemPages: maps and unmaps them.
#include "core/system/system_pages.h"

#include <sys/mman.h>

#include <new>

namespace ovc {

void UnmapPages::operator()(void* pages) const {
    munmap(pages, bytes);
}

SystemPages map_pages(size_t bytes) {
    void* pages = mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    if (pages == MAP_FAILED)
        throw std::bad_alloc();
    return {pages, {bytes}};
}

} // namespace ovc
