// SPDX-License-Identifier: Apache-2.0
// The one source of round_hits() and solve(), compiled for each width of vectors in a file of its
// own with the processor's flags. Everything here is inlined into that file: a function that the
// linker shared with other files could run where the processor lacks the instructions.
#pragma once

#include "core/exact/rounding.h"
#include "core/lanes/hit_lanes.h"
#include "core/lanes/lanes_kernel.h"

namespace ovc {

template <class V>
inline constexpr int kLanesOf = int(sizeof(V) / sizeof(double));

/// Returns the vectors of some of the first `count` lanes. Those behind have the last one's ray.
template <class V>
OVC_INLINE MeetingVectors<V> vectors_of(const MeetingLanes& lanes, int lane, int count) {
    const Ray* rays[kLanesOf<V>];
    for (int i = 0; i < kLanesOf<V>; ++i)
        rays[i] = lanes.rays[smaller(lane + i, count - 1)];
    V ray[8];
    load_rays(rays, ray);
    const auto corner = [&](int i) __attribute__((always_inline)) {
        const auto axis = [&](int k) __attribute__((always_inline)) {
            return load<V>(lanes.corners[3 * i + k] + lane);
        };
        return Vec3Of<V>{axis(0), axis(1), axis(2)};
    };
    return MeetingVectors<V>(Meeting<V>{
        corner(0), corner(1), corner(2), {ray[0], ray[1], ray[2]}, {ray[4], ray[5], ray[6]}});
}
template <class V>
OVC_INLINE void store(double* to, const V& lanes) {
    __builtin_memcpy(to, &lanes, sizeof(V));
}

/// V is a vector of some of the lanes.
template <class V>
OVC_INLINE void round_hits_by(HitLanes& lanes, int count) {
    for (int lane = 0; lane < count; lane += kLanesOf<V>) {
        const MeetingVectors<V> vectors = vectors_of<V>(lanes, lane, count);
        const BoundedSolution<V> s = bounded_solution(vectors);
        const V inverse = 1 / s.value.det.hi;
        const auto over_det = [&](const DoubleDoubleOf<V>& value, V error)
            __attribute__((always_inline)) {
            return quotient(value, error, s.value.det, s.error.det, inverse);
        };
        const Quotient<V> t = over_det(s.value.t, s.error.t);
        Quotient<V> u = over_det(s.value.u, s.error.u);
        Quotient<V> v = over_det(s.value.v, s.error.v);
        const uint32_t used = (1u << smaller(count - lane, kLanesOf<V>)) - 1;
        if (used & ~bits_of<V>(u.is_rounded() & v.is_rounded())) {
            const CloseWeights<V> close(vectors);
            u = over_det(close.u, close.u_error);
            v = over_det(close.v, close.v_error);
        }
        const auto known = (t.is_rounded() & HitLanes::kT) | (u.is_rounded() & HitLanes::kU) |
                           (v.is_rounded() & HitLanes::kV);
        static_assert(sizeof(known) == sizeof(V));
        store(lanes.t + lane, t.value.hi);
        store(lanes.u + lane, u.value.hi);
        store(lanes.v + lane, v.value.hi);
        __builtin_memcpy(lanes.known + lane, &known, sizeof(V));
    }
}

template <class V>
OVC_INLINE void store(SolutionLanes::Number& to, int lane, const DoubleDoubleOf<V>& value,
                      const V& error) {
    store(to[0] + lane, value.hi);
    store(to[1] + lane, value.lo);
    store(to[2] + lane, error);
}

template <class V>
OVC_INLINE void solve_by(const MeetingLanes& lanes, int count, SolutionLanes& solutions) {
    for (int lane = 0; lane < count; lane += kLanesOf<V>) {
        const BoundedSolution<V> s = bounded_solution(vectors_of<V>(lanes, lane, count));
        store(solutions.det, lane, s.value.det, s.error.det);
        store(solutions.u, lane, s.value.u, s.error.u);
        store(solutions.v, lane, s.value.v, s.error.v);
        store(solutions.t, lane, s.value.t, s.error.t);
        const DoubleDoubleOf<V> w = s.w();
        const V w_error = s.w_error();
        const auto positive =
            (w.hi > w_error) | (s.value.u.hi > s.error.u) | (s.value.v.hi > s.error.v);
        const auto negative =
            (w.hi < -w_error) | (s.value.u.hi < -s.error.u) | (s.value.v.hi < -s.error.v);
        const auto missed = positive & negative;
        static_assert(sizeof(missed) == sizeof(V));
        __builtin_memcpy(solutions.missed + lane, &missed, sizeof(V));
    }
}

} // namespace ovc
