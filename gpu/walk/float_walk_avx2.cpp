// SPDX-License-Identifier: Apache-2.0
// float_walk() compiled for AVX2; see float_walk_kernel.h.
#include "gpu/walk/float_walk_kernel.h"

#include <immintrin.h>

namespace ovc {
namespace {

struct Avx2Lanes {
    OVC_INLINE static uint32_t bits(FourBits mask) {
        return uint32_t(_mm_movemask_ps(__m128(mask)));
    }
};

} // namespace

void float_walk_avx2(const WalkedTree& tree, const LocalRay* rays, size_t count, bool any_hit,
                     Named* named) {
    float_walk_by<Avx2Lanes>(tree, rays, count, any_hit, named);
}

} // namespace ovc
