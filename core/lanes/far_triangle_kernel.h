// SPDX-License-Identifier: Apache-2.0
// The one source of meet_far(), compiled like that of round_hits() (hit_lanes_kernel.h).
#pragma once

#include "core/lanes/far_triangle.h"
#include "core/lanes/ray_lanes_kernel.h"

#include <limits>

namespace ovc {

inline constexpr double kFarSlack = 0x1p-48; // more than all roundings of a product

/// Rays and the plane of a far triangle: any hit is at a t in [first, last].
template <class V>
struct FarPlane {
    V org[3]; // counted from the triangle's a
    V reach;
    V first, last;
    MaskOf<V> possible;

    OVC_INLINE FarPlane(const FarTriangle& f, const RaysOf<V>& rays) : reach{} {
        V height{}, rate{};
        for (int axis = 0; axis < 3; ++axis) {
            org[axis] = rays.org[axis] - f.a[axis];
            reach = larger(reach, magnitude(org[axis]));
            height = height + f.normal[axis] * org[axis];
            rate = rate + f.normal[axis] * rays.dir[axis];
        }
        const V inverse = 1 / rate;
        const V below = ((f.lo - height) - kFarSlack * reach) * inverse;
        const V above = ((f.hi - height) + kFarSlack * reach) * inverse;
        const V share = 2 * (kFarSlack * rays.longest() * magnitude(inverse) + kFarSlack);
        const V below_off = magnitude(below) * share, above_off = magnitude(above) * share;
        // Not if the ray runs along the plane, and not with a NaN.
        const MaskOf<V> tells = share <= all_lanes<V>(1e-3);
        first = larger(smaller(below - below_off, above - above_off), rays.from);
        last = smaller(larger(below + below_off, above + above_off), rays.t_max);
        first = tells ? first : rays.from;
        last = tells ? last : rays.t_max;
        possible = ~(first > last);
    }
};

/// Rays and a far triangle: any hit is where they meet its plane.
template <class V>
struct FarHit {
    MaskOf<V> possible, certain;
};

template <class V>
OVC_INLINE FarHit<V> far_hit(const FarTriangle& f, const RaysOf<V>& rays,
                             const FarPlane<V>& plane) {
    FarHit<V> hit{plane.possible, plane.possible};
    if (bits_of<V>(hit.possible) == 0) // as of most rays from the plane itself
        return hit;
    const V longest = rays.longest();
    const V middle = 0.5 * (plane.first + plane.last);
    const V error = longest * (plane.last - plane.first) +
                    kFarSlack * (plane.reach + longest * magnitude(middle));
    V b{}, c{};
    for (int axis = 0; axis < 3; ++axis) {
        const V at = plane.org[axis] + rays.dir[axis] * middle;
        b = b + f.to_b[axis] * at;
        c = c + f.to_c[axis] * at;
    }
    const V weights[3] = {1 - b - c, b, c};
    const V errors[3] = {error * (f.b_size + f.c_size) + (kFarSlack + f.error),
                         error * f.b_size + f.error, error * f.c_size + f.error};
    MaskOf<V> inside = ~MaskOf<V>{}, outside{};
    for (int corner = 0; corner < 3; ++corner) {
        inside &= weights[corner] > errors[corner];
        outside |= weights[corner] < -errors[corner];
    }
    hit.possible &= ~outside;
    hit.certain = hit.possible & inside & (plane.first > rays.from) & (plane.last < rays.t_max);
    return hit;
}

/// The nearest certain hit of rays so far, and from where on others are in doubt.
template <class V>
struct FarNearest {
    V first = all_lanes<V>(std::numeric_limits<double>::infinity());
    V last = first;
    V doubt = first;
    V number{};

    OVC_INLINE void take(const FarHit<V>& hit, const FarPlane<V>& at, double number_of_it,
                         MaskOf<V> seen) {
        const MaskOf<V> certain = hit.certain & seen;
        const MaskOf<V> nearer = certain & (at.last < first);
        // Exact arithmetic tells which of two such hits is the nearer one.
        const MaskOf<V> overlaps = certain & ~nearer & (at.first <= last);
        const MaskOf<V> in_doubt = seen & hit.possible & ~certain;
        doubt = in_doubt ? smaller(doubt, at.first) : doubt;
        doubt = overlaps ? smaller(doubt, smaller(first, at.first)) : doubt;
        last = overlaps ? smaller(last, at.last) : last;
        first = nearer ? at.first : first;
        last = nearer ? at.last : last;
        number = nearer ? all_lanes<V>(number_of_it) : number;
    }
};

template <class V>
OVC_INLINE FarMeeting meet_far_by(std::span<const FarTriangle> triangles, const RayLanes& all,
                                  const uint32_t* skip) {
    constexpr int n = int(sizeof(V) / sizeof(double));
    FarMeeting meeting{};
    for (int lane = 0; lane < RayLanes::kCount; lane += n) {
        const RaysOf<V> rays(all, lane);
        V skipped;
        for (int i = 0; i < n; ++i)
            skipped[i] = skip[lane + i];
        FarNearest<V> nearest;
        for (size_t i = 0; i < triangles.size();) {
            const FarPlane<V> plane(triangles[i], rays);
            do {
                const FarTriangle& triangle = triangles[i];
                nearest.take(far_hit(triangle, rays, plane), plane, triangle.number,
                             skipped != triangle.number);
            } while (++i < triangles.size() && triangles[i].shares_plane);
        }
        constexpr double kNever = std::numeric_limits<double>::infinity();
        const MaskOf<V> hits = nearest.first < all_lanes<V>(kNever);
        const MaskOf<V> unclear =
            (nearest.doubt < all_lanes<V>(kNever)) & (nearest.doubt <= nearest.last);
        meeting.hits |= bits_of<V>(hits) << lane;
        meeting.unclear |= bits_of<V>(unclear) << lane;
        for (int i = 0; i < n; ++i)
            meeting.nearest[lane + i] = uint32_t(nearest.number[i]);
        __builtin_memcpy(meeting.last + lane, &nearest.last, sizeof(V));
    }
    return meeting;
}

} // namespace ovc
