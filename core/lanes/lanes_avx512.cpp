// SPDX-License-Identifier: Apache-2.0
// The functions by lanes by eight doubles at once. Compiled for AVX-512; see hit_lanes_kernel.h.
#include "core/lanes/cull_lanes_kernel.h"
#include "core/lanes/far_triangle_kernel.h"
#include "core/lanes/hit_lanes_kernel.h"
#include "core/lanes/ray_lanes_kernel.h"

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

void round_hits_avx512(HitLanes& lanes, int count) {
    round_hits_by<Eight>(lanes, count);
}
void solve_avx512(const MeetingLanes& lanes, int count, SolutionLanes& solutions) {
    solve_by<Eight>(lanes, count, solutions);
}
uint32_t cull_avx512(const CullRay& ray, CullLanes& lanes) {
    return cull_by<Eight>(ray, lanes);
}
LanesAhead look_ahead_avx512(const LanesScene& scene, const RayLanes& rays) {
    return look_ahead_by<Eight>(scene, rays);
}
void to_frame_avx512(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
                     LocalRows& local) {
    to_frame_by<Eight>(frame, rays, words, local);
}
void gather_avx512(const Ray* const* rays, RayLanes& lanes) {
    gather_by<Eight>(rays, lanes);
}
FarMeeting meet_far_avx512(std::span<const FarTriangle> triangles, const RayLanes& rays,
                           const uint32_t* skip) {
    return meet_far_by<Eight>(triangles, rays, skip);
}

} // namespace ovc
