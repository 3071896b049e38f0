// SPDX-License-Identifier: Apache-2.0
// Ledger: counts the bytes of GL buffers and textures that are alive, and their maximum so far.
#pragma once

#include <algorithm>
#include <cassert>
#include <cstdint>

namespace ovc {

/// The accounts of a budget: every GL object with storage enters its bytes and takes them out
/// again.
struct Ledger {
    uint64_t budget = 0;
    uint64_t in_use = 0;
    uint64_t peak = 0;
    /// Tests simulate a driver with less memory by this.
    uint64_t driver_bytes = ~uint64_t(0);
    bool refused = false; // by that driver, or by the system
    /// Buffers consist of the process's own pages, which a software renderer can use in place.
    bool takes_host_pages = false;

    /// Whether that driver has room for all bytes entered so far.
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
