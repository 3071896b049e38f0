// SPDX-License-Identifier: Apache-2.0
// The one source of float_walk(), compiled for each set of instructions in a file of its own.
// Everything here is inlined into that file (core/lanes/hit_lanes_kernel.h).
// Based on: Woop, Benthin and Wald 2013, "Watertight Ray/Triangle Intersection"; the bounds:
// docs/design/numerics.md.
#pragma once

#include "core/exact/double_double.h"
#include "gpu/bvh/bvh.h"
#include "gpu/walk/float_walk.h"

namespace ovc {

using FourFloats = float __attribute__((vector_size(16)));
using FourBits = int32_t __attribute__((vector_size(16)));
using EightFloats = float __attribute__((vector_size(32)));
using EightBits = int32_t __attribute__((vector_size(32)));

/// A unit that a ray has still to go to.
struct UnitAhead {
    const uint32_t* units; // the array in which the unit and its children are counted
    uint32_t unit;
    float enter; // the t at which the ray comes there
};

/// A triangle that a ray may hit, between lo and hi.
struct Possible {
    uint32_t number;
    float lo, hi;
};

/// A ray on its way, and what it has found.
struct RayOnWay {
    // Each level leaves up to three siblings, in a page and in the top-level tree; all four are
    // written where one more is taken.
    static constexpr int kMaxAhead = 2 * 3 * (kMaxBvhDepth + 1) + 4;

    // For the planes of a node: of the near ones, then of the far ones with the other sign, so that
    // one max() finds where the ray enters all and where it leaves any.
    EightFloats scale[3], offset[3]; // as GridRay of shaders/box.glsl
    int near[3];                     // where a node's texel has the near ones: at word 0 or 2
    EightFloats span;                // where the ray begins and ends

    // As Line of shaders/triangle.glsl.
    int x, y, z; // its axes
    float org[3], shear[2];
    int32_t turned; // the sign bit, if the ray goes down

    uint32_t skip;
    Possible best;  // certain; OVC_MISS: none, and hi is the ray's end
    uint32_t count; // of the further ones
    Possible further[Named::kMax];
    bool is_lost; // more are in doubt than can be named, or the ray itself is
    Named* named; // the answer

    int ahead_count;
    UnitAhead ahead[kMaxAhead]; // the stack: the next one last
};

/// What all rays of a walk share.
struct WalkScene {
    const WalkedTree& tree;
    const uint32_t* top;
    const uint32_t* header;
    bool any_hit;
};

namespace float_walking {

OVC_INLINE uint32_t bits(float x) {
    uint32_t bits;
    __builtin_memcpy(&bits, &x, sizeof bits);
    return bits;
}
OVC_INLINE float as_float(uint32_t bits) {
    float x;
    __builtin_memcpy(&x, &bits, sizeof x);
    return x;
}
OVC_INLINE float magnitude(float x) {
    return as_float(bits(x) & 0x7fffffffu);
}
OVC_INLINE FourFloats magnitude(FourFloats x) {
    return FourFloats(FourBits(x) & 0x7fffffff);
}
OVC_INLINE float lesser(float a, float b) {
    return a < b ? a : b;
}
OVC_INLINE float greater(float a, float b) {
    return a < b ? b : a;
}
template <class V>
OVC_INLINE V load(const uint32_t* from) {
    V v;
    __builtin_memcpy(&v, from, sizeof v);
    return v;
}

OVC_INLINE const uint32_t* words_of(const uvec4* units) {
    const void* const words = units;
    return static_cast<const uint32_t*>(words);
}
OVC_INLINE const uint32_t* unit_at(const uint32_t* units, uint32_t unit) {
    return units + size_t(unit) * (OVC_UNIT_BYTES / sizeof(uint32_t));
}

OVC_INLINE void end_at(RayOnWay& ray, const Possible& best) {
    ray.best = best;
    const float end = -best.hi;
    ray.span = EightFloats{0, 0, 0, 0, end, end, end, end};
}

/// Makes a ray ready for the grid of the tree with this header.
OVC_INLINE void set_grid(RayOnWay& ray, const uint32_t* header, const float* org,
                         const float* dir) {
    for (int axis = 0; axis < 3; ++axis) {
        const float tiny = dir[axis] < 0 ? -1e-18f : 1e-18f; // as finite_reciprocal()
        const float inv_dir = 1.0f / (magnitude(dir[axis]) < 1e-18f ? tiny : dir[axis]);
        const float s = as_float(header[4 + axis]) * inv_dir * (1.0f / 65536.0f);
        const float o = (as_float(header[axis]) - org[axis]) * inv_dir;
        ray.scale[axis] = EightFloats{s, s, s, s, -s, -s, -s, -s};
        ray.offset[axis] = EightFloats{o, o, o, o, -o, -o, -o, -o};
        ray.near[axis] = dir[axis] < 0 ? 2 : 0;
    }
}

/// Makes a ray ready for triangles, as line_of() of shaders/triangle.glsl does.
OVC_INLINE void set_line(RayOnWay& ray, const float* org, const float* dir) {
    const bool along_z = magnitude(dir[2]) == 1.0f;
    const bool along_x = !along_z && magnitude(dir[1]) != 1.0f;
    ray.x = along_x ? 1 : 0;
    ray.y = along_z ? 1 : 2;
    ray.z = along_z ? 2 : (along_x ? 0 : 1);
    ray.turned = int32_t(bits(dir[ray.z]) & 0x80000000u);
    ray.org[0] = org[ray.x];
    ray.org[1] = org[ray.y];
    ray.org[2] = as_float(bits(org[ray.z]) ^ uint32_t(ray.turned));
    ray.shear[0] = dir[ray.x];
    ray.shear[1] = dir[ray.y];
}

OVC_INLINE void set_out(const WalkScene& scene, const LocalRay& from, RayOnWay& ray) {
    float local[8]; // org, t_end, dir, asks
    static_assert(sizeof from == sizeof local);
    __builtin_memcpy(local, &from, sizeof local);
    set_grid(ray, scene.header, local, local + 4);
    set_line(ray, local, local + 4);
    ray.skip = bits(local[7]) & OVC_SKIPS_NONE;
    end_at(ray, {OVC_MISS, 0, local[3]});
    ray.count = 0;
    ray.is_lost = local[3] == OVC_UNDECIDABLE;
    ray.ahead[0] = {scene.top, scene.header[8], 0};
    ray.ahead_count = local[3] >= 0 ? 1 : 0; // OVC_NO_RAY goes nowhere
}

/// Leaves out the further triangles that the best hit certainly hides.
OVC_INLINE void leave_out_hidden(RayOnWay& ray) {
    uint32_t kept = 0;
    for (uint32_t i = 0; i < ray.count; ++i)
        if (ray.further[i].lo <= ray.best.hi)
            ray.further[kept++] = ray.further[i];
    ray.count = kept;
}

OVC_INLINE void add_further(RayOnWay& ray, const Possible& possible) {
    // A triangle that planes cut comes once for each of its parts.
    for (uint32_t i = 0; i < ray.count; ++i)
        if (ray.further[i].number == possible.number)
            return;
    if (ray.count == Named::kMax)
        leave_out_hidden(ray);
    ray.is_lost = ray.count == Named::kMax;
    if (!ray.is_lost)
        ray.further[ray.count++] = possible;
}

/// Takes in a triangle that the ray may hit, or certainly hits.
OVC_INLINE void take(RayOnWay& ray, const Possible& possible, bool certain) {
    if (possible.hi < 0 || possible.lo > ray.best.hi)
        return;
    if (!certain || possible.lo <= 0 || possible.hi >= ray.best.hi)
        return add_further(ray, possible);
    const Possible before = ray.best;
    end_at(ray, possible);
    if (before.number != OVC_MISS && before.lo <= possible.hi)
        add_further(ray, before);
}

/// Four corners in coordinates in which the ray is the z axis, and the max error of any.
struct FourCorners {
    FourFloats x, y, z;
    FourFloats size; // |x| + |y|
    float error;
};

/// x, y, z: the coordinates by the ray's axes.
OVC_INLINE FourCorners corners_of(const RayOnWay& ray, FourFloats x, FourFloats y, FourFloats z) {
    FourCorners c;
    c.z = FourFloats(FourBits(z) ^ ray.turned) - ray.org[2];
    c.x = (x - ray.org[0]) - c.z * ray.shear[0];
    c.y = (y - ray.org[1]) - c.z * ray.shear[1];
    c.size = magnitude(c.x) + magnitude(c.y);
    const FourFloats reach = c.size + magnitude(c.z);
    const float largest = greater(greater(reach[0], reach[1]), greater(reach[2], reach[3]));
    c.error = float(OVC_BOUND_UNIT * OVC_BOUND_CONSTANT) +
              float(OVC_BOUND_UNIT * OVC_BOUND_RELATIVE) * largest;
    return c;
}

/// Tests the triangle of corners 0, k and 2 as edges_of(), passing_of() and candidate() of
/// shaders/triangle.glsl do. Lanes: what the instructions have for vectors.
template <class Lanes, int k>
OVC_INLINE void test_triangle(RayOnWay& ray, const FourCorners& c, uint32_t number) {
    const auto from = [](FourFloats v) __attribute__((always_inline)) {
        return __builtin_shufflevector(v, v, 0, k, 2, 0);
    };
    const auto to = [](FourFloats v) __attribute__((always_inline)) {
        return __builtin_shufflevector(v, v, k, 2, 0, k);
    };
    const FourFloats edge = from(c.x) * to(c.y) - from(c.y) * to(c.x);
    const FourFloats error = c.error * ((from(c.size) + c.error) + (to(c.size) + c.error));
    const uint32_t positive = Lanes::bits(edge > error) & 7u;
    const uint32_t negative = Lanes::bits(edge < -error) & 7u;
    const bool outside = positive != 0 && negative != 0;
    if (outside || number == ray.skip || number == ray.best.number)
        return;
    const float lo = lesser(lesser(c.z[0], c.z[2]), c.z[k]);
    const float hi = greater(greater(c.z[0], c.z[2]), c.z[k]);
    const float depth_error = 2.0f * c.error;
    if (positive != 7 && negative != 7) // not certainly inside
        return take(ray, {number, lo - depth_error, hi + depth_error}, false);
    const float inv_area = 1.0f / (edge[0] + edge[1] + edge[2]);
    const float t = (edge[1] * c.z[0] + edge[2] * c.z[k] + edge[0] * c.z[2]) * inv_area;
    const float share =
        float(OVC_BOUND_SHARE) * (error[0] + error[1] + error[2]) * magnitude(inv_area);
    const float t_error = share * (hi - lo) + depth_error;
    take(ray, {number, t - t_error, t + t_error}, true);
}

/// The coordinate in the upper 24 bits of a word of a loose pair, and the one in the low bytes of
/// three words.
OVC_INLINE float upper_of(uint32_t word) {
    return float(int32_t(word) >> 8) * float(OVC_LOOSE_STEP);
}
OVC_INLINE float low_of(const uint32_t* w) {
    return upper_of(w[2] << 24 | (w[1] & 0xffu) << 16 | (w[0] & 0xffu) << 8);
}

/// Tests a triangle by itself.
template <class Lanes>
OVC_INLINE void test_alone(RayOnWay& ray, const float (&corners)[3][3], uint32_t number) {
    const auto along = [&](int axis) __attribute__((always_inline)) {
        return FourFloats{corners[0][axis], corners[1][axis], corners[2][axis], corners[0][axis]};
    };
    test_triangle<Lanes, 1>(ray, corners_of(ray, along(ray.x), along(ray.y), along(ray.z)), number);
}

template <class Lanes>
OVC_INLINE void test_loose_pair(RayOnWay& ray, const uint32_t* w) {
    const float a[3][3] = {{upper_of(w[0]), upper_of(w[1]), upper_of(w[2])},
                           {upper_of(w[4]), upper_of(w[5]), upper_of(w[6])},
                           {upper_of(w[8]), upper_of(w[9]), upper_of(w[10])}};
    const float b[3][3] = {
        {upper_of(w[12]), upper_of(w[13]), upper_of(w[14])},
        {low_of(w), low_of(w + 4), low_of(w + 8)},
        {low_of(w + 12), upper_of(w[11]), upper_of(w[11] << 24 | (w[15] & 0xffffu) << 8)}};
    test_alone<Lanes>(ray, a, w[3]);
    if (w[7] != OVC_NO_TRIANGLE)
        test_alone<Lanes>(ray, b, w[7]);
}

template <class Lanes>
OVC_INLINE void test_pair(RayOnWay& ray, const uint32_t* w) {
    if (w[15] & OVC_LOOSE_PAIR)
        return test_loose_pair<Lanes>(ray, w);
    FourFloats v[4];
    for (int i = 0; i < 4; ++i)
        v[i] = load<FourFloats>(w + 4 * i);
    const FourFloats xy01 = __builtin_shufflevector(v[0], v[1], 0, 4, 1, 5);
    const FourFloats xy23 = __builtin_shufflevector(v[2], v[3], 0, 4, 1, 5);
    const FourFloats z01 = __builtin_shufflevector(v[0], v[1], 2, 6, 3, 7);
    const FourFloats z23 = __builtin_shufflevector(v[2], v[3], 2, 6, 3, 7);
    const FourFloats along[3] = {__builtin_shufflevector(xy01, xy23, 0, 1, 4, 5),
                                 __builtin_shufflevector(xy01, xy23, 2, 3, 6, 7),
                                 __builtin_shufflevector(z01, z23, 0, 1, 4, 5)};
    const FourCorners c = corners_of(ray, along[ray.x], along[ray.y], along[ray.z]);
    test_triangle<Lanes, 1>(ray, c, w[3]);
    if (w[7] != OVC_NO_TRIANGLE)
        test_triangle<Lanes, 3>(ray, c, w[7]);
}

/// Returns the words of a texel, from the one at `near` on; 0 or 2.
OVC_INLINE FourBits near_first(const uint32_t* texel, int near) {
    using TwoWords = long long __attribute__((vector_size(16)));
    TwoWords words;
    long long half;
    __builtin_memcpy(&half, texel + near, sizeof half);
    words[0] = half;
    __builtin_memcpy(&half, texel + (near ^ 2), sizeof half);
    words[1] = half;
    return FourBits(words);
}

/// Sets t to the times of the eight planes in a texel of a node.
OVC_INLINE void times_at(const RayOnWay& ray, int axis, const uint32_t* texel, EightFloats& t) {
    const FourBits words = near_first(texel, ray.near[axis]);
    const EightBits planes = __builtin_shufflevector(words, words, 0, 0, 1, 1, 2, 2, 3, 3)
                             << EightBits{16, 0, 16, 0, 16, 0, 16, 0};
    t = __builtin_convertvector(planes, EightFloats) * ray.scale[axis] + ray.offset[axis];
}

/// Returns the numbers in descending order, by a network of five comparisons.
OVC_INLINE FourBits descending(FourBits k) {
    FourBits other = __builtin_shufflevector(k, k, 1, 0, 3, 2);
    FourBits least = k < other ? k : other, most = k < other ? other : k;
    k = __builtin_shufflevector(most, least, 0, 5, 2, 7);
    other = __builtin_shufflevector(k, k, 2, 3, 0, 1);
    least = k < other ? k : other, most = k < other ? other : k;
    k = __builtin_shufflevector(most, least, 0, 1, 6, 7);
    other = __builtin_shufflevector(k, k, 0, 2, 1, 3);
    least = k < other ? k : other, most = k < other ? other : k;
    return __builtin_shufflevector(most, least, 0, 1, 6, 3);
}

/// Puts the children of a node that the ray meets before all others, the nearest first. A branch
/// for each number of children would be guessed wrong too often.
template <class Lanes>
OVC_INLINE void go_down(RayOnWay& ray, const uint32_t* node, const uint32_t* below,
                        uint32_t first_child) {
    EightFloats inside = ray.span;
    for (int axis = 0; axis < 3; ++axis) {
        EightFloats t;
        times_at(ray, axis, node + 4 * axis, t);
        inside = t > inside ? t : inside;
    }
    const FourFloats enter = __builtin_shufflevector(inside, inside, 0, 1, 2, 3);
    const FourFloats exit = -__builtin_shufflevector(inside, inside, 4, 5, 6, 7);
    const FourBits met = enter <= exit;
    // Floats that are not negative are in the order of their bits; the lowest two tell the child.
    const FourBits key = (FourBits(enter) & ~3) | FourBits{0, 1, 2, 3};
    const FourBits order = descending(met ? key : FourBits{-1, -1, -1, -1});
    const FourBits unit = int32_t(first_child) + (order & 3), at = order & ~3;

    using TwoWords = long long __attribute__((vector_size(16)));
    static_assert(sizeof(UnitAhead) == sizeof(TwoWords) && sizeof below == sizeof(long long));
    const TwoWords far = TwoWords(__builtin_shufflevector(unit, at, 0, 4, 1, 5));
    const TwoWords near = TwoWords(__builtin_shufflevector(unit, at, 2, 6, 3, 7));
    const TwoWords units = TwoWords{} + reinterpret_cast<long long>(below);
    const TwoWords ahead[4] = {
        __builtin_shufflevector(units, far, 0, 2), __builtin_shufflevector(units, far, 0, 3),
        __builtin_shufflevector(units, near, 0, 2), __builtin_shufflevector(units, near, 0, 3)};
    __builtin_memcpy(&ray.ahead[ray.ahead_count], ahead, sizeof ahead);
    ray.ahead_count += __builtin_popcount(Lanes::bits(met));
}

/// Goes to the next unit that the best hit does not hide. Returns false where the ray is done.
template <class Lanes>
OVC_INLINE bool go_on(const WalkScene& scene, RayOnWay& ray) {
    UnitAhead next;
    do {
        if (ray.ahead_count == 0)
            return false;
        next = ray.ahead[--ray.ahead_count];
    } while (next.enter > ray.best.hi);
    const uint32_t* const unit = unit_at(next.units, next.unit);
    if (unit[15] & OVC_PAIR) {
        test_pair<Lanes>(ray, unit);
        return !ray.is_lost && !(scene.any_hit && ray.best.number != OVC_MISS);
    }
    const uint32_t* below = next.units;
    uint32_t first_child = unit[12];
    if (below == scene.top && unit[13] != 0) { // a link
        below = words_of(scene.tree.units_of(scene.tree.pages, unit[13] - 1));
        first_child = unit[14];
    }
    for (uint32_t child = 0; child < 4; ++child)
        __builtin_prefetch(unit_at(below, first_child + child));
    go_down<Lanes>(ray, unit, below, first_child);
    return true;
}

OVC_INLINE void answer(RayOnWay& ray, bool any_hit) {
    leave_out_hidden(ray);
    const bool enough = ray.is_lost || (any_hit && ray.best.number != OVC_MISS);
    ray.named->certain = ray.is_lost ? OVC_FLAGGED : ray.best.number;
    ray.named->count = enough ? 0 : ray.count;
    for (uint32_t i = 0; i < ray.named->count; ++i)
        ray.named->further[i] = ray.further[i].number;
}

} // namespace float_walking

/// Walks the rays in turns, so that some fetch their next units while others test theirs.
template <class Lanes>
OVC_INLINE void float_walk_by(const WalkedTree& tree, const LocalRay* rays, size_t count,
                              bool any_hit, Named* named) {
    using namespace float_walking;
    constexpr size_t kTogether = 8;
    const uint32_t* const top = words_of(tree.top);
    const WalkScene scene{tree, top, unit_at(top, tree.header), any_hit};
    RayOnWay some[kTogether];
    RayOnWay* on_way[kTogether];
    size_t next = 0, on_way_count = 0;
    for (; next < count && next < kTogether; ++next) {
        RayOnWay& ray = some[next];
        set_out(scene, rays[next], ray);
        ray.named = &named[next];
        on_way[on_way_count++] = &ray;
    }
    while (on_way_count > 0)
        for (size_t i = 0; i < on_way_count;) {
            RayOnWay& ray = *on_way[i];
            if (go_on<Lanes>(scene, ray)) {
                ++i;
                continue;
            }
            answer(ray, any_hit);
            if (next == count) {
                on_way[i] = on_way[--on_way_count];
                continue;
            }
            set_out(scene, rays[next], ray);
            ray.named = &named[next++];
        }
}

} // namespace ovc
