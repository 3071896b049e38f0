// SPDX-License-Identifier: Apache-2.0
// cull(): tells of eight triangles at once which certainly are not the nearest hit of a ray, by the
// widest vectors that the processor has. Where thousands of triangles lie in the way of one ray,
// few are left for exact arithmetic.
#pragma once

#include <cstdint>
#include <vector>

namespace ovc {

/// Eight triangles, which may have corners that are not finite.
struct CullLanes {
    static constexpr int kCount = 8;
    static constexpr uint32_t kAll = (1u << kCount) - 1;

    alignas(64) double corner[3][3][kCount]; // [corner][axis][lane]
    alignas(64) long long key[kCount];       // names, in the order in which equal t is decided
    /// Filled in by cull(): a lane that it leaves probably comes the earlier the less this is.
    alignas(64) double lead[kCount];
};

/// A ray, and what is known of its nearest hit so far. core/lanes/cull_batch.h fills it in.
struct CullRay {
    // The ray, as in PreparedRay.
    int kx, ky, kz;
    double sx, sy, sz;
    double org[3], dir[3];
    double t_min, t_max;
    /// A point near the triangles, and the moment of the ray about it, (org - reference) x dir, in
    /// doubled precision. Where the ray begins there or near, its origin, and no moment.
    double reference[3];
    double moment_high[3], moment_low[3];

    bool has_hit = false;
    // The rest counts only with a hit: its t as in Candidate, its name and its corners.
    double t, t_low, t_error;
    long long key;
    double corner[3][3]; // [corner][axis]
    /// The numbers of the corners that it lies on, if it is a corner or lies on a side.
    int support[2];
    int support_count = 0;

    /// Whether the plane of the hit's triangle is known to cross the ray.
    bool has_plane = false;
    /// Distances from it count in units, a power of two.
    double per_unit; // 1 / unit
    /// The normal to the side that the ray goes to, in doubled precision and square units; and with
    /// the terms of its components taken by magnitude.
    double normal_high[3], normal_low[3], normal_size[3];
    /// Whether the corners of the hit's triangle are multiples of a unit apart.
    bool has_units = false;
    unsigned long long normal_in_units[3]; // modulo 2^64
};

/// Returns which of the lanes may hold the nearest hit, a bit each: of any other, the triangle is
/// missed, or hit behind the nearest hit so far in the order of t and key. Of the
/// triangles that are hit nearest, or not told apart, it leaves more on some processors.
uint32_t cull(const CullRay& ray, CullLanes& lanes);

/// Returns a cull() per width of vectors that the processor has, the widest last: for tests.
using Cull = uint32_t (*)(const CullRay&, CullLanes&);
std::vector<Cull> ways_to_cull();

} // namespace ovc
