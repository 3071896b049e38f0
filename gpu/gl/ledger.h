// SPDX-License-Identifier: Apache-2.0
// Ledger: how many bytes of GL buffers and textures are alive, and the most there ever were.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace ovc {

/// The budget in books: every GL object with storage enters its bytes and takes them out again.
struct Ledger {
    uint64_t budget = 0;
    uint64_t in_use = 0;
    uint64_t peak = 0;
    /// For tests: a driver that has no more memory than this.
    uint64_t driver_bytes = ~uint64_t(0);
    bool refused = false; // by that driver, or by the system
    /// Buffers are of the process's own pages: the driver is a part of it.
    bool takes_host_pages = false;

    /// Whether that driver has room for what is entered.
    bool driver_has_room() {
        refused = refused || in_use > driver_bytes;
        return !refused;
    }

    void add(uint64_t bytes) {
        in_use += bytes;
        peak = std::max(peak, in_use);
        assert(in_use <= budget);
    }
    void remove(uint64_t bytes) {
        assert(bytes <= in_use);
        in_use -= bytes;
    }
};

} // namespace ovc
