// SPDX-License-Identifier: Apache-2.0
// round_hits() for any processor, and the choice of the widest vectors.
#include "core/exact/hit_lanes.h"

#include "core/exact/hit_lanes_kernel.h"

namespace ovc {

void round_hits_avx2(HitLanes& lanes);   // hit_lanes_avx2.cpp
void round_hits_avx512(HitLanes& lanes); // hit_lanes_avx512.cpp

namespace {

using Two = double __attribute__((vector_size(16)));
using TwoWords = long long __attribute__((vector_size(16)));

} // namespace

/// Computes the error without a fused operation. Based on: Dekker 1971, with Veltkamp's splitting.
template <>
struct Lanes<Two> {
    OVC_INLINE static Two product_error(Two a, Two b, Two product) {
        const Two a_high = high(a), b_high = high(b);
        const Two a_low = a - a_high, b_low = b - b_high;
        return ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low;
    }
    OVC_INLINE static Two magnitude(Two x) {
        const TwoWords all_but_sign = TwoWords{} + 0x7fffffffffffffffLL;
        return reinterpret_cast<Two>(reinterpret_cast<TwoWords>(x) & all_but_sign);
    }

private:
    /// Returns the upper 26 bits of x.
    OVC_INLINE static Two high(Two x) {
        const Two scaled = 134217729.0 * x; // 2^27 + 1
        return scaled - (scaled - x);
    }
};

static void round_hits_anywhere(HitLanes& lanes) {
    round_hits_by<Two>(lanes);
}

std::vector<RoundHits> ways_to_round_hits() {
    std::vector<RoundHits> ways = {round_hits_anywhere};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        ways.push_back(round_hits_avx2);
    if (__builtin_cpu_supports("avx512f"))
        ways.push_back(round_hits_avx512);
#endif
    return ways;
}

void round_hits(HitLanes& lanes) {
    static const RoundHits widest = ways_to_round_hits().back();
    widest(lanes);
}

} // namespace ovc
