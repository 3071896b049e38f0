// SPDX-License-Identifier: Apache-2.0
// Random numbers for tests, the same on every machine.
#pragma once

#include "core/vec.h"

#include <cstdint>
#include <random>

namespace ovc::test {

/// Returns uniform numbers in [lo, hi), made from raw bits so that they are the same everywhere.
class Random {
public:
    explicit Random(uint64_t seed) : engine_(seed) {}

    double operator()(double lo, double hi) {
        return lo + (hi - lo) * (double(engine_() >> 11) * 0x1p-53);
    }
    dvec3 point(double lo, double hi) {
        return {(*this)(lo, hi), (*this)(lo, hi), (*this)(lo, hi)};
    }
    uint64_t below(uint64_t n) { return engine_() % n; }

private:
    std::mt19937_64 engine_;
};

} // namespace ovc::test
