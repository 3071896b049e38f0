// SPDX-License-Identifier: Apache-2.0
// The one source of meet_children(), compiled for each width of vectors in a file of its own with
// the processor's flags. Everything here is inlined into that file (core/lanes/hit_lanes_kernel.h).
#pragma once

#include "core/exact/double_double.h"
#include "gpu/page/node_lanes.h"

#include <limits>

namespace ovc {

// Where a processor has shorter vectors, the compiler takes several of them.
using FourDoubles = double __attribute__((vector_size(32)));
using FourMasks = long long __attribute__((vector_size(32)));
using FourInts = int32_t __attribute__((vector_size(16)));

/// Converts integers to doubles: Wide has a conversion of four at once where the processor does.
struct Anywhere {
    OVC_INLINE static void convert(const FourInts& from, FourDoubles& to) {
        to = __builtin_convertvector(from, FourDoubles);
    }
};

/// The coordinates of the boxes of four children along an axis.
template <class Wide>
struct NodeRanges {
    FourDoubles lo, hi;

    /// texel: as gpu/page/node_boxes.h packs it.
    OVC_INLINE explicit NodeRanges(const uint32_t* texel) {
        FourInts words;
        __builtin_memcpy(&words, texel, sizeof words);
        const FourInts less{1, 1, 0, 0};
        const FourInts even = (words & 0xffff) ^ 0x8000;
        const FourInts odd = (((words >> 16) & 0xffff) ^ 0x8000) + less;
        Wide::convert(__builtin_shufflevector(even, odd, 0, 4, 1, 5), lo);
        Wide::convert(__builtin_shufflevector(even, odd, 2, 6, 3, 7), hi);
    }
};

/// Returns for each child how many of the others enter later, or at the same t and come before it.
OVC_INLINE void find_places(const FourDoubles& enter, FourMasks& places) {
    const FourDoubles next = __builtin_shufflevector(enter, enter, 1, 2, 3, 0);
    const FourDoubles across = __builtin_shufflevector(enter, enter, 2, 3, 0, 1);
    const FourDoubles last = __builtin_shufflevector(enter, enter, 3, 0, 1, 2);
    // True where the other child comes before: for the next one only where it is child 0.
    const FourMasks next_before{0, 0, 0, -1}, across_before{0, 0, -1, -1};
    const FourMasks last_before{0, -1, -1, -1};
    places = -((next > enter) | ((next == enter) & next_before));
    places -= (across > enter) | ((across == enter) & across_before);
    places -= (last > enter) | ((last == enter) & last_before);
}

/// The stretches of a ray in the boxes of four children.
struct Stretches {
    FourDoubles enter, exit;

    OVC_INLINE explicit Stretches(const NodeRay& ray)
        : enter(FourDoubles{} + ray.from), exit(FourDoubles{} + ray.to) {}

    /// Cuts off what lies outside of the boxes along an axis. lo, hi: their bounds there, from grid
    /// coordinate 0 on.
    OVC_INLINE void clip(const NodeRay& ray, int axis, const FourDoubles& lo,
                         const FourDoubles& hi) {
        const FourDoubles inverse = FourDoubles{} + ray.inv_dir[axis];
        const FourDoubles t_lo = ((ray.lo[axis] + lo) - ray.org[axis]) * inverse;
        const FourDoubles t_hi = ((ray.hi[axis] + hi) - ray.org[axis]) * inverse;
        const FourMasks turned = inverse < 0.0;
        const FourDoubles near = turned ? t_hi : t_lo, far = turned ? t_lo : t_hi;
        // Where the ray runs along a side, 0 times infinity is NaN, which leaves the bound as it
        // was.
        enter = near > enter ? near : enter;
        exit = far < exit ? far : exit;
    }
};

template <class Wide>
OVC_INLINE void meet_children_by(const NodeRays& rays, RaySet which, const uint32_t* texels,
                                 NodeMeeting& meeting) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    FourDoubles lo[3], hi[3];
    FourMasks there = ~FourMasks{};
    for (int axis = 0; axis < 3; ++axis) {
        const NodeRanges<Wide> range(texels + 4 * axis);
        there &= range.lo <= range.hi;
        lo[axis] = range.lo * rays.cell[axis];
        hi[axis] = range.hi * rays.cell[axis];
    }
    FourDoubles enter = FourDoubles{} + kInfinity;
    FourMasks meeting_rays{};
    for (; which != 0; which &= which - 1) {
        const int i = __builtin_ctz(which);
        const NodeRay& ray = rays.rays[i];
        Stretches stretch(ray);
        for (int axis = 0; axis < 3; ++axis)
            stretch.clip(ray, axis, lo[axis], hi[axis]);
        const FourMasks met = (stretch.enter <= stretch.exit) & there;
        enter = (met & (stretch.enter < enter)) ? stretch.enter : enter;
        meeting_rays |= met & (1LL << i);
    }
    const FourMasks met = meeting_rays != 0;
    enter = met ? enter : FourDoubles{} - kInfinity;
    FourMasks places;
    find_places(enter, places);
    __builtin_memcpy(meeting.enter, &enter, sizeof enter);
    __builtin_memcpy(meeting.rays, &meeting_rays, sizeof meeting_rays);
    __builtin_memcpy(meeting.place, &places, sizeof places);
    meeting.count = uint32_t(-(met[0] + met[1] + met[2] + met[3]));
}

} // namespace ovc
