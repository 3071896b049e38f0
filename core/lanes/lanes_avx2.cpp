// SPDX-License-Identifier: Apache-2.0
// The functions by lanes by four doubles at once. Compiled for AVX2 with FMA; see
// hit_lanes_kernel.h.
#include "core/lanes/cull_lanes_kernel.h"
#include "core/lanes/far_triangle_kernel.h"
#include "core/lanes/hit_lanes_kernel.h"
#include "core/lanes/ray_lanes_kernel.h"

#include <immintrin.h>

namespace ovc {

using Four = double __attribute__((vector_size(32)));

template <>
struct Lanes<Four> {
    OVC_INLINE static Four product_error(Four a, Four b, Four product) {
        return _mm256_fmsub_pd(a, b, product);
    }
    OVC_INLINE static Four magnitude(Four x) { return _mm256_andnot_pd(_mm256_set1_pd(-0.0), x); }
    OVC_INLINE static uint32_t bits(MaskOf<Four> mask) {
        return uint32_t(_mm256_movemask_pd(reinterpret_cast<Four>(mask)));
    }
};

void round_hits_avx2(HitLanes& lanes, int count) {
    round_hits_by<Four>(lanes, count);
}
void solve_avx2(const MeetingLanes& lanes, int count, SolutionLanes& solutions) {
    solve_by<Four>(lanes, count, solutions);
}
uint32_t cull_avx2(const CullRay& ray, CullLanes& lanes) {
    return cull_by<Four>(ray, lanes);
}
LanesAhead look_ahead_avx2(const LanesScene& scene, const RayLanes& rays) {
    return look_ahead_by<Four>(scene, rays);
}
void to_frame_avx2(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
                   LocalRows& local) {
    to_frame_by<Four>(frame, rays, words, local);
}
void gather_avx2(const Ray* const* rays, RayLanes& lanes) {
    gather_by<Four>(rays, lanes);
}
FarMeeting meet_far_avx2(std::span<const FarTriangle> triangles, const RayLanes& rays,
                         const uint32_t* skip) {
    return meet_far_by<Four>(triangles, rays, skip);
}

} // namespace ovc
