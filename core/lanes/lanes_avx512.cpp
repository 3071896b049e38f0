// SPDX-License-Identifier: Apache-2.0
// round_hits() and cull() by eight doubles at once. Compiled for AVX-512; see hit_lanes_kernel.h.
#include "core/lanes/cull_lanes_kernel.h"
#include "core/lanes/hit_lanes_kernel.h"

#include <immintrin.h>

namespace ovc {

using Eight = double __attribute__((vector_size(64)));

template <>
struct Lanes<Eight> {
    OVC_INLINE static Eight product_error(Eight a, Eight b, Eight product) {
        return _mm512_fmsub_pd(a, b, product);
    }
    OVC_INLINE static Eight magnitude(Eight x) { return _mm512_abs_pd(x); }
    OVC_INLINE static uint32_t bits(MaskOf<Eight> mask) {
        return _mm512_movepi64_mask(reinterpret_cast<__m512i>(mask));
    }
};

void round_hits_avx512(HitLanes& lanes) {
    round_hits_by<Eight>(lanes);
}
uint32_t cull_avx512(const CullRay& ray, CullLanes& lanes) {
    return cull_by<Eight>(ray, lanes);
}

} // namespace ovc
