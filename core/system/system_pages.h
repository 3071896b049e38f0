// SPDX-License-Identifier: Apache-2.0
// Pages of memory straight from the system.
#pragma once

#include <cstddef>
#include <memory>

namespace ovc {

/// Given back, they leave the process at once. What malloc gets back it may keep.
struct UnmapPages {
    size_t bytes = 0;

    void operator()(void* pages) const;
};
using SystemPages = std::unique_ptr<void, UnmapPages>;

/// Zeros, which the system finds on first touch: what is never used costs nothing. At the start of
/// a page. Throws std::bad_alloc.
SystemPages map_pages(size_t bytes);

} // namespace ovc
