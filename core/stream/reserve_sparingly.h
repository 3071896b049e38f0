// SPDX-License-Identifier: Apache-2.0
// Arrays of the rays that are under way are most of what tracing takes of memory.
#pragma once

#include <cstddef>
#include <vector>

namespace ovc {

/// Makes room for `count` items, and for a quarter more where there was none, instead of as much
/// again.
template <class T>
void reserve_sparingly(std::vector<T>& items, size_t count) {
    if (count > items.capacity())
        items.reserve(count + count / 4);
}

} // namespace ovc
