// SPDX-License-Identifier: Apache-2.0
// MemorySize is an amount of memory as people write it, "256M" or "50%". Beside it, bytes and
// counts are formatted as people read them.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <string>
#include <string_view>

namespace ovc {

/// A number of bytes, or a share of what a device has. Where both are 0 it means the default.
struct MemorySize {
    uint64_t bytes = 0;
    double share = 0; // in (0, 1]

    /// Returns the bytes on a device with device_bytes. 0 means the default, or a share that is
    /// less than one byte.
    uint64_t of(uint64_t device_bytes) const {
        return share > 0 ? uint64_t(share * double(device_bytes)) : bytes;
    }
};

/// Parses "1000" (bytes), "256M" or "256MiB" (x 2^20), "256MB" (x 10^6), likewise K, G, T, in any
/// case, fractions allowed; or "50%". Error: anything else, less than one byte, 2^50 bytes or more,
/// more than 100 %.
Result<MemorySize> parse_memory_size(std::string_view text);

/// Parses the value of an option such as --host-memory. Error: as above, or a share; the sentence
/// begins with the option.
Result<uint64_t> parse_bytes(std::string_view option, std::string_view text);

/// Returns a text such as "12.0 MiB" or "640 bytes".
std::string human_bytes(uint64_t bytes);

/// Returns the count with commas, as in "871,414".
std::string human_count(uint64_t count);

} // namespace ovc
