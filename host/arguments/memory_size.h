// SPDX-License-Identifier: Apache-2.0
// MemorySize: an amount of memory as people write it, "256M" or "50%", and bytes as people read
// them.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace ovc {

/// A number of bytes, or a share of what a device has; neither: the default.
struct MemorySize {
    uint64_t bytes = 0;
    double share = 0; // in (0, 1]

    /// Of a device with device_bytes. 0: the default, or a share that is less than one byte.
    uint64_t of(uint64_t device_bytes) const {
        return share > 0 ? uint64_t(share * double(device_bytes)) : bytes;
    }
};

/// "1000" (bytes), "256M" or "256MiB" (x 2^20), "256MB" (x 10^6), likewise K, G, T, in any case,
/// fractions allowed; "50%". Error: anything else, less than one byte, above 100 %.
Result<MemorySize> parse_memory_size(std::string_view text);

/// "12.0 MiB", "640 bytes".
std::string human_bytes(uint64_t bytes);

/// "871,414".
std::string human_count(uint64_t count);

} // namespace ovc
