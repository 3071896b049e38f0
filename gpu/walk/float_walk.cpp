// SPDX-License-Identifier: Apache-2.0
// float_walk() for any processor, and the choice of the best instructions.
#include "gpu/walk/float_walk_kernel.h"

namespace ovc {

// float_walk_avx2.cpp
void float_walk_avx2(const WalkedTree& tree, const LocalRay* rays, size_t count, bool any_hit,
                     Named* named);

namespace {

struct FourLanes {
    OVC_INLINE static uint32_t bits(FourBits mask) {
        return uint32_t((mask[0] & 1) | (mask[1] & 2) | (mask[2] & 4) | (mask[3] & 8));
    }
};

void float_walk_anywhere(const WalkedTree& tree, const LocalRay* rays, size_t count, bool any_hit,
                         Named* named) {
    float_walk_by<FourLanes>(tree, rays, count, any_hit, named);
}

} // namespace

std::vector<FloatWalk> float_walks() {
    std::vector<FloatWalk> walks = {float_walk_anywhere};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2"))
        walks.push_back(float_walk_avx2);
#endif
    return walks;
}

FloatWalk float_walk() {
    static const FloatWalk best = float_walks().back();
    return best;
}

} // namespace ovc
