// SPDX-License-Identifier: Apache-2.0
// Pages of memory straight from the system.
#pragma once

#include <cstddef>
#include <memory>

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

} // namespace ovc
