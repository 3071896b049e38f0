// SPDX-License-Identifier: Apache-2.0
// The one source of look_ahead() and to_frame(), compiled like that of round_hits()
// (hit_lanes_kernel.h). Each line does what the function for one ray does, in the same order.
#pragma once

#include "core/lanes/lanes_kernel.h"
#include "core/lanes/ray_lanes.h"

#include <limits>

namespace ovc {

/// Floats, and integers of their size, beside the doubles of V.
template <class V>
struct FloatsType {
    typedef float Type __attribute__((vector_size(sizeof(V) / 2)));
    typedef unsigned Words __attribute__((vector_size(sizeof(V) / 2)));
};
template <class V>
using FloatsOf = typename FloatsType<V>::Type;

/// The part of rays inside something.
template <class V>
struct Inside {
    V enter, exit;
};

/// Some of the rays, as vectors.
template <class V>
struct RaysOf {
    V org[3], dir[3], t_min, t_max, from;

    OVC_INLINE RaysOf(const RayLanes& rays, int lane)
        : t_min(load<V>(rays.t_min + lane)),
          t_max(load<V>(rays.t_max + lane)),
          from(load<V>(rays.from + lane)) {
        for (int axis = 0; axis < 3; ++axis) {
            org[axis] = load<V>(rays.org[axis] + lane);
            dir[axis] = load<V>(rays.dir[axis] + lane);
        }
    }
    OVC_INLINE V longest() const {
        return larger(larger(magnitude(dir[0]), magnitude(dir[1])), magnitude(dir[2]));
    }
};

template <class V>
OVC_INLINE LanesAhead look_ahead(const LanesScene& scene, const RaysOf<V>& rays) {
    constexpr double kMax = std::numeric_limits<double>::max();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    const V longest = rays.longest();
    MaskOf<V> valid =
        are_finite(rays.t_min) & (rays.t_min <= rays.t_max) & (longest >= all_lanes<V>(1e-300));
    MaskOf<V> walks = (longest >= all_lanes<V>(kMinWalkedDirection)) &
                      (longest <= all_lanes<V>(kMaxWalkedDirection));
    MaskOf<V> outside{};
    V reach{}, enter = rays.from, exit = smaller(all_lanes<V>(kMax), rays.t_max);
    for (int axis = 0; axis < 3; ++axis) {
        const V org = rays.org[axis], dir = rays.dir[axis], inv_dir = 1.0 / dir;
        const MaskOf<V> is_flat = dir == V{};
        valid &= are_finite(org) & are_finite(dir);
        walks &= is_flat | are_finite(inv_dir);
        reach = larger(reach, larger(magnitude(scene.bounds.lo[axis] - org),
                                     magnitude(scene.bounds.hi[axis] - org)));
        outside |= is_flat & ((org < scene.padded.lo[axis]) | (org > scene.padded.hi[axis]));
        const V a = (scene.padded.lo[axis] - org) * inv_dir;
        const V b = (scene.padded.hi[axis] - org) * inv_dir;
        const MaskOf<V> is_down = inv_dir < V{};
        const V near = is_flat ? all_lanes<V>(-kInfinity) : (is_down ? b : a);
        const V far = is_flat ? all_lanes<V>(kInfinity) : (is_down ? a : b);
        enter = near > enter ? near : enter; // A NaN leaves it as it was.
        exit = far < exit ? far : exit;
    }
    if (!scene.is_empty)
        walks &= 0x1p-46 * reach <= all_lanes<V>(scene.padding);
    return {bits_of<V>(valid), bits_of<V>(walks), bits_of<V>(~outside & (enter <= exit))};
}

template <class V>
OVC_INLINE LanesAhead look_ahead_by(const LanesScene& scene, const RayLanes& rays) {
    LanesAhead all{};
    for (int lane = 0; lane < RayLanes::kCount; lane += int(sizeof(V) / sizeof(double))) {
        const LanesAhead some = look_ahead(scene, RaysOf<V>(rays, lane));
        all.valid |= some.valid << lane;
        all.walks |= some.walks << lane;
        all.meets |= some.meets << lane;
    }
    return all;
}

template <class V>
OVC_INLINE Inside<V> inside_box(const LanesBox& box, const RaysOf<V>& rays) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    Inside<V> inside{rays.from, rays.t_max};
    MaskOf<V> outside{};
    for (int axis = 0; axis < 3; ++axis) {
        const V org = rays.org[axis], inv_dir = 1.0 / rays.dir[axis];
        const MaskOf<V> is_flat = rays.dir[axis] == V{};
        outside |= is_flat & ((org < box.lo[axis]) | (org > box.hi[axis]));
        const V a = (box.lo[axis] - org) * inv_dir, b = (box.hi[axis] - org) * inv_dir;
        const V near = is_flat ? all_lanes<V>(-kInfinity) : (b < a ? b : a);
        const V far = is_flat ? all_lanes<V>(kInfinity) : (a < b ? b : a);
        inside.enter = inside.enter < near ? near : inside.enter;
        inside.exit = far < inside.exit ? far : inside.exit;
    }
    return {outside ? all_lanes<V>(1) : inside.enter, outside ? V{} : inside.exit};
}

/// Returns LocalRay::t_end: t_end_of() of gpu/trace/local_ray.cpp.
template <class V>
OVC_INLINE FloatsOf<V> t_end_of(const LanesFrame& frame, const RaysOf<V>& rays,
                                const Inside<V>& inside, V speed, V reach) {
    using Floats = FloatsOf<V>;
    using Words = typename FloatsType<V>::Words;
    const MaskOf<V> is_ray = (inside.enter <= inside.exit) & (rays.t_max >= rays.from);
    const V length = (inside.exit - inside.enter) * speed;
    const MaskOf<V> decidable = (reach <= all_lanes<V>(frame.max_reach)) & (length <= 1e30) &
                                (speed >= 1e-300) & (speed <= 1e300);
    const Floats rounded = __builtin_convertvector(length, Floats);
    Words words;
    __builtin_memcpy(&words, &rounded, sizeof(words));
    words += 2; // rounded up
    Floats t_end;
    __builtin_memcpy(&t_end, &words, sizeof(words));
    t_end = __builtin_convertvector(decidable, Words) ? t_end : Floats{} + frame.undecidable;
    return __builtin_convertvector(is_ray, Words) ? t_end : Floats{} + frame.no_ray;
}

/// Writes columns of as many rows as a vector has elements, from `lane` on.
template <class V>
OVC_INLINE void store_rows(LocalRows& local, int lane, const FloatsOf<V> (&columns)[8]) {
    constexpr int n = int(sizeof(V) / sizeof(double));
    for (int column = 0; column < 8; column += n) {
        FloatsOf<V> rows[n];
        for (int i = 0; i < n; ++i)
            rows[i] = columns[column + i];
        transpose(rows);
        for (int i = 0; i < n; ++i)
            __builtin_memcpy(&local.rows[lane + i][column], &rows[i], sizeof(rows[i]));
    }
}

template <class V>
OVC_INLINE void to_frame_by(const LanesFrame& frame, const RayLanes& all, const uint32_t* words,
                            LocalRows& local) {
    using Floats = FloatsOf<V>;
    for (int lane = 0; lane < RayLanes::kCount; lane += int(sizeof(V) / sizeof(double))) {
        const RaysOf<V> rays(all, lane);
        const Inside<V> inside = inside_box(frame.box, rays);
        const V longest = rays.longest(), speed = longest * frame.scale, shorter = 1.0 / longest;
        Floats columns[8];
        V reach{};
        for (int axis = 0; axis < 3; ++axis) {
            const V from_origin = rays.org[axis] - frame.origin[axis];
            const V travelled = rays.dir[axis] * inside.enter;
            reach = larger(reach, larger(magnitude(from_origin), magnitude(travelled)));
            columns[LocalRows::kDir + axis] =
                __builtin_convertvector(rays.dir[axis] * shorter, Floats);
            columns[LocalRows::kOrg + axis] =
                __builtin_convertvector((from_origin + travelled) * frame.scale, Floats);
        }
        columns[LocalRows::kEnd] = t_end_of(frame, rays, inside, speed, reach * frame.scale);
        __builtin_memcpy(&columns[LocalRows::kWord], words + lane, sizeof(Floats));
        store_rows<V>(local, lane, columns);
    }
}

template <class V>
OVC_INLINE void gather_by(const Ray* const* rays, RayLanes& lanes) {
    double* const to[8] = {lanes.org[0], lanes.org[1], lanes.org[2], lanes.t_min,
                           lanes.dir[0], lanes.dir[1], lanes.dir[2], lanes.t_max};
    for (int lane = 0; lane < RayLanes::kCount; lane += int(sizeof(V) / sizeof(double))) {
        V columns[8];
        load_rays(rays + lane, columns);
        for (const int t : {3, 7})
            columns[t] = columns[t] + 0.0; // -0 becomes 0
        for (int i = 0; i < 8; ++i)
            __builtin_memcpy(to[i] + lane, &columns[i], sizeof(V));
        __builtin_memcpy(lanes.from + lane, &columns[3], sizeof(V));
    }
}

} // namespace ovc
