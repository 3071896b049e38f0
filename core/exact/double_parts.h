// SPDX-License-Identifier: Apache-2.0
// DoubleParts: a double as an integer times a power of two.
#pragma once

#include <algorithm>
#include <bit>
#include <cassert>
#include <cstdint>

namespace ovc {

/// |x| = mantissa * 2^power, where x is finite.
struct DoubleParts {
    uint64_t mantissa; // below 2^53
    int power;         // at least -1074

    explicit DoubleParts(double x) {
        const uint64_t bits = std::bit_cast<uint64_t>(x);
        const int stored = int(bits >> 52 & 0x7ff); // 0 for denormals, which have no leading 1
        assert(stored != 0x7ff);
        mantissa = (bits & ((uint64_t(1) << 52) - 1)) | uint64_t(stored != 0) << 52;
        power = std::max(stored, 1) - 1075;
    }
};

} // namespace ovc
