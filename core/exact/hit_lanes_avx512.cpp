// SPDX-License-Identifier: Apache-2.0
// round_hits() by eight doubles at once. Compiled for AVX-512; see hit_lanes_kernel.h.
#include "core/exact/hit_lanes_kernel.h"

#include <immintrin.h>

namespace ovc {

using Eight = double __attribute__((vector_size(64)));

template <>
struct Lanes<Eight> {
    OVC_INLINE static Eight product_error(Eight a, Eight b, Eight product) {
        return _mm512_fmsub_pd(a, b, product);
    }
    OVC_INLINE static Eight magnitude(Eight x) { return _mm512_abs_pd(x); }
};

void round_hits_avx512(HitLanes& lanes) {
    round_hits_by<Eight>(lanes);
}

} // namespace ovc
