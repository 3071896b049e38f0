// SPDX-License-Identifier: Apache-2.0
// meet_children() by four doubles at once. Compiled for AVX2; see node_lanes_kernel.h.
#include "gpu/page/node_lanes_kernel.h"

#include <immintrin.h>

namespace ovc {
namespace {

struct Avx2 {
    OVC_INLINE static void convert(const FourInts& from, FourDoubles& to) {
        to = _mm256_cvtepi32_pd(__m128i(from));
    }
};

} // namespace

void meet_children_avx2(const NodeRays& rays, RaySet which, const uint32_t* texels,
                        NodeMeeting& meeting) {
    meet_children_by<Avx2>(rays, which, texels, meeting);
}

} // namespace ovc
