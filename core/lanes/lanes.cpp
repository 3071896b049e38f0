// SPDX-License-Identifier: Apache-2.0
// The functions by lanes for any processor, and the choice of the widest vectors.
#include "core/lanes/cull_lanes_kernel.h"
#include "core/lanes/far_triangle_kernel.h"
#include "core/lanes/hit_lanes_kernel.h"
#include "core/lanes/ray_lanes_kernel.h"

namespace ovc {

// In lanes_avx2.cpp and lanes_avx512.cpp.
void round_hits_avx2(HitLanes& lanes, int count);
void round_hits_avx512(HitLanes& lanes, int count);
void solve_avx2(const MeetingLanes& lanes, int count, SolutionLanes& solutions);
void solve_avx512(const MeetingLanes& lanes, int count, SolutionLanes& solutions);
uint32_t cull_avx2(const CullRay& ray, CullLanes& lanes);
uint32_t cull_avx512(const CullRay& ray, CullLanes& lanes);
LanesAhead look_ahead_avx2(const LanesScene& scene, const RayLanes& rays);
LanesAhead look_ahead_avx512(const LanesScene& scene, const RayLanes& rays);
void to_frame_avx2(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
                   LocalRows& local);
void to_frame_avx512(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
                     LocalRows& local);
void gather_avx2(const Ray* const* rays, RayLanes& lanes);
void gather_avx512(const Ray* const* rays, RayLanes& lanes);
FarMeeting meet_far_avx2(std::span<const FarTriangle> triangles, const RayLanes& rays,
                         const uint32_t* skip);
FarMeeting meet_far_avx512(std::span<const FarTriangle> triangles, const RayLanes& rays,
                           const uint32_t* skip);

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

    OVC_INLINE static uint32_t bits(MaskOf<Two> mask) {
        return uint32_t(mask[0] & 1) | uint32_t(mask[1] & 2);
    }

private:
    /// Returns the upper 26 bits of x.
    OVC_INLINE static Two high(Two x) {
        const Two scaled = 134217729.0 * x; // 2^27 + 1
        return scaled - (scaled - x);
    }
};

static void round_hits_anywhere(HitLanes& lanes, int count) {
    round_hits_by<Two>(lanes, count);
}
static void solve_anywhere(const MeetingLanes& lanes, int count, SolutionLanes& solutions) {
    solve_by<Two>(lanes, count, solutions);
}
static uint32_t cull_anywhere(const CullRay& ray, CullLanes& lanes) {
    return cull_by<Two>(ray, lanes);
}
static LanesAhead look_ahead_anywhere(const LanesScene& scene, const RayLanes& rays) {
    return look_ahead_by<Two>(scene, rays);
}
static void to_frame_anywhere(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
                              LocalRows& local) {
    to_frame_by<Two>(frame, rays, words, local);
}
static void gather_anywhere(const Ray* const* rays, RayLanes& lanes) {
    gather_by<Two>(rays, lanes);
}
static FarMeeting meet_far_anywhere(std::span<const FarTriangle> triangles, const RayLanes& rays,
                                    const uint32_t* skip) {
    return meet_far_by<Two>(triangles, rays, skip);
}

namespace {

template <class Function>
std::vector<Function> ways(Function anywhere, [[maybe_unused]] Function avx2,
                           [[maybe_unused]] Function avx512) {
    std::vector<Function> found = {anywhere};
#ifdef __x86_64__
    if (__builtin_cpu_supports("avx2") && __builtin_cpu_supports("fma"))
        found.push_back(avx2);
    if (__builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512dq"))
        found.push_back(avx512);
#endif
    return found;
}

} // namespace

#ifdef __x86_64__
#define OVC_WAYS(name) ways(name##_anywhere, name##_avx2, name##_avx512)
#else
#define OVC_WAYS(name) ways(name##_anywhere, name##_anywhere, name##_anywhere)
#endif

std::vector<RoundHits> ways_to_round_hits() {
    return OVC_WAYS(round_hits);
}
std::vector<Solve> ways_to_solve() {
    return OVC_WAYS(solve);
}
std::vector<Cull> ways_to_cull() {
    return OVC_WAYS(cull);
}
std::vector<LookAhead> ways_to_look_ahead() {
    return OVC_WAYS(look_ahead);
}
std::vector<ToFrame> ways_to_frame() {
    return OVC_WAYS(to_frame);
}
std::vector<Gather> ways_to_gather() {
    return OVC_WAYS(gather);
}
std::vector<MeetFar> ways_to_meet_far() {
    return OVC_WAYS(meet_far);
}

void round_hits(HitLanes& lanes, int count) {
    static const RoundHits widest = ways_to_round_hits().back();
    widest(lanes, count);
}
void solve(const MeetingLanes& lanes, int count, SolutionLanes& solutions) {
    static const Solve widest = ways_to_solve().back();
    widest(lanes, count, solutions);
}
uint32_t cull(const CullRay& ray, CullLanes& lanes) {
    static const Cull widest = ways_to_cull().back();
    return widest(ray, lanes);
}
LanesAhead look_ahead(const LanesScene& scene, const RayLanes& rays) {
    static const LookAhead widest = ways_to_look_ahead().back();
    return widest(scene, rays);
}
void to_frame(const LanesFrame& frame, const RayLanes& rays, const uint32_t* words,
              LocalRows& local) {
    static const ToFrame widest = ways_to_frame().back();
    widest(frame, rays, words, local);
}
void gather(const Ray* const* rays, RayLanes& lanes) {
    static const Gather widest = ways_to_gather().back();
    widest(rays, lanes);
}
FarMeeting meet_far(std::span<const FarTriangle> triangles, const RayLanes& rays,
                    const uint32_t* skip) {
    static const MeetFar widest = ways_to_meet_far().back();
    return widest(triangles, rays, skip);
}

} // namespace ovc
