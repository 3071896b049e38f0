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

template <class Wide>
OVC_INLINE void meet_children_by(const NodeRay& ray, const uint32_t* texels, double to,
                                 NodeMeeting& meeting) {
    FourDoubles enter = FourDoubles{} + ray.from, exit = FourDoubles{} + to;
    FourMasks missing{};
    for (int axis = 0; axis < 3; ++axis) {
        const NodeRanges<Wide> range(texels + 4 * axis);
        missing |= range.lo > range.hi;
        const FourDoubles cell = FourDoubles{} + ray.cell[axis];
        const FourDoubles inverse = FourDoubles{} + ray.inv_dir[axis];
        const FourDoubles t_lo = ((ray.lo[axis] + range.lo * cell) - ray.org[axis]) * inverse;
        const FourDoubles t_hi = ((ray.hi[axis] + range.hi * cell) - ray.org[axis]) * inverse;
        const FourMasks turned = inverse < 0.0;
        const FourDoubles near = turned ? t_hi : t_lo, far = turned ? t_lo : t_hi;
        // Where the ray runs along a side, 0 times infinity is NaN, which leaves the bound as it
        // was.
        enter = near > enter ? near : enter;
        exit = far < exit ? far : exit;
    }
    const FourMasks met = (enter <= exit) & ~missing;
    const FourDoubles never = FourDoubles{} - std::numeric_limits<double>::infinity();
    enter = met ? enter : never;
    FourMasks places;
    find_places(enter, places);
    __builtin_memcpy(meeting.enter, &enter, sizeof enter);
    __builtin_memcpy(meeting.place, &places, sizeof places);
    meeting.count = uint32_t(-(met[0] + met[1] + met[2] + met[3]));
}

} // namespace ovc
