// SPDX-License-Identifier: Apache-2.0
// Sobol's first two dimensions, with Owen's scrambling, anew for each purpose.
// Based on: Burley 2020, "Practical Hash-based Owen Scrambling", JCGT 9(4), with the hash of
// Vegdahl 2021, "Building a Better LK Hash"; the mixing of Steele, Lea and Flood 2014 (SplitMix).
#include "host/shade/path_sampler.h"

namespace ovc {

static uint64_t mixed(uint64_t x) {
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

static uint32_t reversed(uint32_t x) {
    x = ((x & 0x55555555u) << 1) | ((x >> 1) & 0x55555555u);
    x = ((x & 0x33333333u) << 2) | ((x >> 2) & 0x33333333u);
    x = ((x & 0x0f0f0f0fu) << 4) | ((x >> 4) & 0x0f0f0f0fu);
    return __builtin_bswap32(x);
}

/// Scrambles a number whose bits run backwards as Owen does: the bits below a bit decide whether it
/// is flipped.
static uint32_t scrambled_backwards(uint32_t x, uint32_t seed) {
    x ^= x * 0x3d20adeau;
    x += seed;
    x *= (seed >> 16) | 1;
    x ^= x * 0x05526c56u;
    x ^= x * 0x53a22864u;
    return x;
}

static uint32_t scrambled(uint32_t x, uint32_t seed) {
    return reversed(scrambled_backwards(reversed(x), seed));
}

/// Returns the second dimension of Sobol's sequence: Pascal's triangle modulo 2 (Kollig and Keller
/// 2002).
static uint32_t sobol_second(uint32_t index) {
    uint32_t bits = 0;
    for (uint32_t column = 1u << 31; index != 0; index >>= 1, column ^= column >> 1)
        if (index & 1)
            bits ^= column;
    return bits;
}

PathSampler::PathSampler(uint64_t seed, uint32_t pixel, uint32_t sample)
    : pixel_(mixed(mixed(seed + 0x9e3779b97f4a7c15u) + pixel)), sample_(sample) {}

dvec2 PathSampler::pair(uint32_t purpose) const {
    const uint64_t order = mixed(pixel_ + 0x9e3779b97f4a7c15u * (uint64_t(purpose) + 1));
    const uint64_t scrambling = mixed(order);
    // The samples are taken in another order for each purpose; the first 2^k stay together.
    const uint32_t index = scrambled(sample_, uint32_t(order));
    const uint32_t x = scrambled(reversed(index), uint32_t(scrambling));
    const uint32_t y = scrambled(sobol_second(index), uint32_t(scrambling >> 32));
    return dvec2(x, y) * 0x1p-32;
}

} // namespace ovc
