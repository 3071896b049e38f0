// SPDX-License-Identifier: Apache-2.0
// Random numbers that depend on a seed and nothing else. They use no distribution of std, because
// these differ between libraries.
#pragma once

#include "core/vec.h"

#include <cstdint>

namespace ovc {

/// Mixes 64 bits well (the finalizer of Steele, Lea and Flood 2014, "SplitMix").
constexpr uint64_t mix_bits(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

/// A stream of numbers. Draw several in one expression only inside braces, which are evaluated in
/// order.
class Random {
public:
    explicit Random(uint64_t seed) : state_(mix_bits(seed)) {}
    Random(uint64_t seed, uint64_t stream) : Random(mix_bits(seed) ^ stream) {}

    uint64_t bits() { return mix_bits(state_++); }
    uint32_t below(uint32_t count) { return uint32_t((bits() >> 32) * count >> 32); }
    /// Returns a number in [0, 1) or [from, to).
    double uniform() { return double(bits() >> 11) * 0x1p-53; }
    double uniform(double from, double to) { return from + (to - from) * uniform(); }
    bool chance(double probability) { return uniform() < probability; }

    /// Returns a point inside the unit ball, evenly distributed.
    dvec3 in_ball() {
        for (;;) {
            const dvec3 p{uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)};
            if (glm::dot(p, p) <= 1)
                return p;
        }
    }
    /// Returns a point on the unit sphere, evenly distributed.
    dvec3 direction() {
        for (;;) {
            const dvec3 p = in_ball();
            if (glm::dot(p, p) > 1e-4)
                return glm::normalize(p);
        }
    }

private:
    uint64_t state_;
};

} // namespace ovc
