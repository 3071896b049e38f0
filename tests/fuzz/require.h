// SPDX-License-Identifier: Apache-2.0
// require(): the check of the fuzz targets, which stays on in builds without assertions.
#pragma once

#include <cstdlib>

namespace ovc {

/// Aborts, which a fuzzer reports as a crash, unless the condition holds.
inline void require(bool condition) {
    if (!condition)
        std::abort();
}

} // namespace ovc
