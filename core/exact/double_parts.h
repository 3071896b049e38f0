// SPDX-License-Identifier: Apache-2.0
// A double as the integer that it is, times a power of two.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>

namespace ovc {

/// |x| = mantissa * 2^power, of a finite x.
struct DoubleParts {
    uint64_t mantissa; // below 2^53
    int power;         // -1074 at least

    explicit DoubleParts(double x) {
        const uint64_t bits = std::bit_cast<uint64_t>(x);
        const int stored = int(bits >> 52 & 0x7ff); // 0 for denormals, which have no leading 1
        mantissa = (bits & ((uint64_t(1) << 52) - 1)) | uint64_t(stored != 0) << 52;
        power = std::max(stored, 1) - 1075;
    }
};

} // namespace ovc
