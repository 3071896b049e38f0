// SPDX-License-Identifier: Apache-2.0
// The one source of round_hits(), compiled for each width of vectors in a file of its own with the
// processor's flags. Everything here is inlined into that file: a function that the linker shared
// with other files could run where the processor lacks the instructions.
#pragma once

#include "core/exact/rounding.h"
#include "core/lanes/hit_lanes.h"
#include "core/lanes/lanes_kernel.h"

namespace ovc {

template <class V>
OVC_INLINE Vec3Of<V> load(const HitLanes::Vec& from, int lane) {
    return {load<V>(from[0] + lane), load<V>(from[1] + lane), load<V>(from[2] + lane)};
}

/// V is a vector of some of the lanes.
template <class V>
OVC_INLINE void round_hits_by(HitLanes& lanes) {
    for (int lane = 0; lane < HitLanes::kCount; lane += int(sizeof(V) / sizeof(double))) {
        const Meeting<V> meeting{load<V>(lanes.a, lane), load<V>(lanes.b, lane),
                                 load<V>(lanes.c, lane), load<V>(lanes.org, lane),
                                 load<V>(lanes.dir, lane)};
        const BoundedSolution<V> s = bounded_solution(meeting);
        const V inverse = 1 / s.value.det.hi;
        const auto over_det = [&](const DoubleDoubleOf<V>& value, V error)
            __attribute__((always_inline)) {
            return quotient(value, error, s.value.det, s.error.det, inverse);
        };
        const Quotient<V> t = over_det(s.value.t, s.error.t);
        const Quotient<V> u = over_det(s.value.u, s.error.u);
        const Quotient<V> v = over_det(s.value.v, s.error.v);
        const auto known = t.is_rounded() & u.is_rounded() & v.is_rounded();
        static_assert(sizeof(known) == sizeof(V));
        __builtin_memcpy(lanes.t + lane, &t.value.hi, sizeof(V));
        __builtin_memcpy(lanes.u + lane, &u.value.hi, sizeof(V));
        __builtin_memcpy(lanes.v + lane, &v.value.hi, sizeof(V));
        __builtin_memcpy(lanes.known + lane, &known, sizeof(V));
    }
}

} // namespace ovc
