// SPDX-License-Identifier: Apache-2.0
// Hashes of corners and of triangles.
#pragma once

#include "core/soup.h"

#include <bit>
#include <cstdint>

namespace ovc {

/// Maps each number to another one, so that each bit of x changes distant bits of the result.
inline uint64_t mix(uint64_t x) {
    x ^= x >> 32;
    x *= 0xd6e8feb86659fd93u;
    x ^= x >> 32;
    return x;
}

/// Returns the hash of a corner, which is the same for 0 and -0, because these are one place.
inline uint64_t corner_hash(const dvec3& p) {
    const auto word = [](double x) { return std::bit_cast<uint64_t>(x + 0.0); };
    return mix(word(p.x) * 0x9e3779b97f4a7c15u + word(p.y) * 0xc2b2ae3d27d4eb4fu +
               word(p.z) * 0x165667b19e3779f9u);
}

/// Returns the hash of a triangle, which is the same for each order of its corners.
inline uint64_t triangle_hash(const Triangle& t) {
    return mix(corner_hash(t[0]) + corner_hash(t[1]) + corner_hash(t[2]));
}

} // namespace ovc
