// SPDX-License-Identifier: Apache-2.0
// The one source of cull(), compiled like that of round_hits() (hit_lanes_kernel.h). The bounds are
// derived in docs/design/numerics.md, "What a ray may cost".
#pragma once

#include "core/exact/rounding.h"
#include "core/lanes/cull_lanes.h"
#include "core/lanes/lanes_kernel.h"

namespace ovc {

template <class V>
OVC_INLINE Vec3Of<V> in_all_lanes(const double (&v)[3]) {
    return {all_lanes<V>(v[0]), all_lanes<V>(v[1]), all_lanes<V>(v[2])};
}

/// Triangles, [corner][axis].
template <class V>
struct Corners {
    V at[3][3];

    OVC_INLINE Corners(const CullLanes& lanes, int lane) {
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis)
                at[i][axis] = load<V>(lanes.corner[i][axis] + lane);
    }
    /// Whether a coordinate is one that Chunk::triangle() might replace.
    OVC_INLINE MaskOf<V> may_be_out_of_range() const {
        MaskOf<V> out{};
        for (int i = 0; i < 3; ++i)
            for (int axis = 0; axis < 3; ++axis) {
                const V size = magnitude(at[i][axis]);
                out |= (size > 0x1p256) | ((size < 0x1p-256) & (size != 0.0));
            }
        return out;
    }
    OVC_INLINE Vec3Of<V> vector(int i) const { return {at[i][0], at[i][1], at[i][2]}; }
    /// Whether corner i lies where corner k of the nearest hit does.
    OVC_INLINE MaskOf<V> equals(int i, const CullRay& ray, int k) const {
        return (at[i][0] == ray.corner[k][0]) & (at[i][1] == ray.corner[k][1]) &
               (at[i][2] == ray.corner[k][2]);
    }
    OVC_INLINE MaskOf<V> has(const CullRay& ray, int k) const {
        return equals(0, ray, k) | equals(1, ray, k) | equals(2, ray, k);
    }
};

/// The weights of the corners in the point where the ray meets the plane of a triangle, times a
/// number that is not told.
template <class V>
struct Weights {
    V value[3], error[3];
    MaskOf<V> is_outside, is_inside; // for certain

    /// Tells both, where all weights are entered.
    OVC_INLINE void compare() {
        MaskOf<V> positive{}, negative{};
        is_inside = ~MaskOf<V>{};
        for (int i = 0; i < 3; ++i) {
            positive |= value[i] > error[i];
            negative |= value[i] < -error[i];
            is_inside &= magnitude(value[i]) > error[i];
        }
        is_outside = positive & negative;
        is_inside &= ~is_outside;
    }
};

/// The test in doubles, as candidate() in core/exact/triangle.h has it.
template <class V>
struct TestInDoubles {
    Weights<V> weights;
    V t, t_error; // where all weights are certain
    MaskOf<V> is_missed;
};

/// Corners in the basis of the ray.
template <class V>
struct Projected {
    V x[3], y[3], z[3], size[3], reach[3];

    OVC_INLINE Projected(const CullRay& ray, const CullLanes& lanes, int lane) {
        for (int i = 0; i < 3; ++i) {
            const auto from_org = [&](int axis) __attribute__((always_inline)) {
                return load<V>(lanes.corner[i][axis] + lane) - ray.org[axis];
            };
            z[i] = from_org(ray.kz);
            x[i] = from_org(ray.kx) - ray.sx * z[i];
            y[i] = from_org(ray.ky) - ray.sy * z[i];
            size[i] = magnitude(x[i]) + magnitude(y[i]);
            reach[i] = size[i] + magnitude(z[i]);
        }
    }
    OVC_INLINE V edge(int i, int j) const { return x[i] * y[j] - y[i] * x[j]; }
    OVC_INLINE V edge_error(int i, int j) const {
        constexpr double u = 0x1p-53;
        return 12 * u * (reach[i] * size[j] + reach[j] * size[i] + 12 * u * reach[i] * reach[j]) +
               0x1p-814;
    }
};

template <class V>
OVC_INLINE TestInDoubles<V> test_in_doubles(const CullRay& ray, const CullLanes& lanes, int lane) {
    constexpr double u = 0x1p-53;
    const Projected<V> p(ray, lanes, lane);
    TestInDoubles<V> test;
    Weights<V>& w = test.weights;
    for (int k = 0; k < 3; ++k) {
        const int i = (k + 2) % 3, j = (k + 1) % 3;
        w.value[k] = p.edge(i, j);
        w.error[k] = p.edge_error(i, j);
    }
    w.compare();
    const V area = w.value[0] + w.value[1] + w.value[2];
    const V of_z = w.value[0] * p.z[0] + w.value[1] * p.z[1] + w.value[2] * p.z[2];
    test.t = of_z / area * ray.sz;
    const V errors = w.error[0] + w.error[1] + w.error[2];
    const V per_area = 1 / magnitude(area);
    const V share = smaller(2 * errors * per_area, all_lanes<V>(1));
    const V z_min = smaller(smaller(p.z[0], p.z[1]), p.z[2]);
    const V z_max = larger(larger(p.z[0], p.z[1]), p.z[2]);
    test.t_error = (share * (z_max - z_min) + 12 * u * larger(magnitude(z_min), magnitude(z_max)) +
                    0x1p-1000 * (per_area + 1)) *
                       magnitude(all_lanes<V>(ray.sz)) +
                   0x1p-1020;
    // A t that comes out infinite may be one of doubles all the same.
    test.t_error = are_finite(test.t) ? test.t_error : all_lanes<V>(__builtin_inf());
    const MaskOf<V> before = test.t + test.t_error < ray.t_min;
    const MaskOf<V> beyond = test.t - test.t_error > ray.t_max;
    test.is_missed = w.is_outside | (w.is_inside & (before | beyond));
    return test;
}

/// On which side of the plane of the nearest hit corners lie.
template <class V>
struct Sides {
    V distance[3], error[3]; // in units, times the length of the normal; positive: farther
    MaskOf<V> is_known[3];   // the sign of the distance is
    MaskOf<V> behind[3], on[3];

    OVC_INLINE void leave_open(int i) {
        distance[i] = error[i] = V{};
        is_known[i] = behind[i] = on[i] = MaskOf<V>{};
    }
    OVC_INLINE MaskOf<V> all_known() const { return is_known[0] & is_known[1] & is_known[2]; }
    OVC_INLINE MaskOf<V> all_behind() const { return behind[0] & behind[1] & behind[2]; }
    OVC_INLINE MaskOf<V> none_before() const {
        return (behind[0] | on[0]) & (behind[1] | on[1]) & (behind[2] | on[2]);
    }
};

/// A corner in units, from a corner of the nearest hit; and what bounds its distance.
template <class V>
struct Offset {
    DoubleDoubleOf<V> by[3];
    V size; // of the terms of the distance, taken by magnitude

    OVC_INLINE Offset(const CullRay& ray, const Corners<V>& corners, int i) : size{} {
        for (int axis = 0; axis < 3; ++axis) {
            const DoubleDoubleOf<V> d =
                two_difference(corners.at[i][axis], all_lanes<V>(ray.corner[0][axis]));
            by[axis] = {d.hi * ray.per_unit, d.lo * ray.per_unit};
            size += ray.normal_size[axis] * magnitude(by[axis].hi);
        }
    }
};

/// Tells the sides of corners whose distance is an integer of less than 2^62.
template <class V>
OVC_INLINE void find_side_in_integers(Sides<V>& sides, const CullRay& ray, const Offset<V>& offset,
                                      int i) {
    constexpr double kMagic = 0x1.8p52; // adding it rounds to an integer, which the low bits hold
    V about{}, reach{};
    MaskOf<V> integers = ~MaskOf<V>{};
    WordsOf<V> exactly{}; // modulo 2^64
    for (int axis = 0; axis < 3; ++axis) {
        const V by = offset.by[axis].hi, rounded = by + kMagic;
        integers &= (rounded - kMagic == by) & (offset.by[axis].lo == 0);
        reach += magnitude(by);
        about += by * ray.normal_high[axis];
        const WordsOf<V> bits = words_of(rounded) - words_of(all_lanes<V>(kMagic));
        exactly += bits * ray.normal_in_units[axis];
    }
    const V error = 0x1p-50 * offset.size;
    const MaskOf<V> known = integers & (reach < 0x1p51) & (magnitude(about) + error < 0x1p62);
    const MaskOf<V> sign = MaskOf<V>(exactly), zero{};
    sides.is_known[i] = known;
    sides.behind[i] = known & (sign > zero);
    sides.on[i] = known & (sign == zero);
    sides.distance[i] = sides.on[i] ? V{} : about;
    sides.error[i] = sides.on[i] ? V{} : error;
}

/// Tells the sides of corners in doubled precision, where they are not known.
template <class V>
OVC_INLINE void find_side_closely(Sides<V>& sides, const CullRay& ray, const Corners<V>& corners,
                                  const Offset<V>& offset, int i) {
    DoubleDoubleOf<V> sum{};
    V low{};
    for (int axis = 0; axis < 3; ++axis) {
        const DoubleDoubleOf<V>& by = offset.by[axis];
        const DoubleDoubleOf<V> product = two_product(by.hi, all_lanes<V>(ray.normal_high[axis]));
        low += product.lo + (by.hi * ray.normal_low[axis] + by.lo * ray.normal_high[axis]);
        sum = two_sum(sum.hi, product.hi);
        low += sum.lo;
    }
    const MaskOf<V> unknown = ~sides.is_known[i];
    const V distance = sum.hi + low, error = 0x1p-100 * offset.size + 0x1p-1000;
    sides.behind[i] |= unknown & (distance > error);
    sides.distance[i] = unknown ? distance : sides.distance[i];
    sides.error[i] = unknown ? error + 0x1p-52 * magnitude(distance) : sides.error[i];
    if (bits_of<V>(unknown & ~(magnitude(distance) > error)) == 0)
        return;
    const MaskOf<V> on = (corners.equals(i, ray, 0) | corners.equals(i, ray, 1) |
                          corners.equals(i, ray, 2) | (offset.size == 0)) &
                         unknown;
    sides.on[i] |= on;
    sides.distance[i] = on ? V{} : sides.distance[i];
    sides.error[i] = on ? V{} : sides.error[i];
}

/// Returns the moment of the ray about corners, their cross product with its direction taken off
/// that about the reference point. size: receives the terms taken by magnitude.
template <class V>
OVC_INLINE Vec3Of<DoubleDoubleOf<V>> moment_about(const CullRay& ray, const Vec3Of<V>& corner,
                                                  Vec3Of<MagnitudeOf<V>>& size) {
    const Vec3Of<V> dir = in_all_lanes<V>(ray.dir);
    const Vec3Of<DoubleDoubleOf<V>> from = exact_difference(corner, in_all_lanes<V>(ray.reference));
    const Vec3Of<DoubleDoubleOf<V>> turned = cross(from, dir);
    const Vec3Of<MagnitudeOf<V>> turned_size = cross(magnitudes(from), magnitudes(dir));
    const auto component = [&](int axis) __attribute__((always_inline)) {
        return DoubleDoubleOf<V>{all_lanes<V>(ray.moment_high[axis]),
                                 all_lanes<V>(ray.moment_low[axis])};
    };
    const Vec3Of<DoubleDoubleOf<V>> moment{component(0), component(1), component(2)};
    const Vec3Of<MagnitudeOf<V>> moment_size = magnitudes(moment);
    size = {moment_size.x + turned_size.x, moment_size.y + turned_size.y,
            moment_size.z + turned_size.z};
    return {moment.x - turned.x, moment.y - turned.y, moment.z - turned.z};
}

/// Returns the weights in doubled precision: moments about a corner, multiplied by the sides there.
template <class V>
OVC_INLINE Weights<V> weights_closely(const CullRay& ray, const Corners<V>& corners) {
    const Vec3Of<V> a = corners.vector(0), b = corners.vector(1), c = corners.vector(2);
    Vec3Of<MagnitudeOf<V>> about_a_size, about_c_size;
    const Vec3Of<DoubleDoubleOf<V>> about_a = moment_about(ray, a, about_a_size);
    const Vec3Of<DoubleDoubleOf<V>> about_c = moment_about(ray, c, about_c_size);
    const Vec3Of<DoubleDoubleOf<V>> cb = exact_difference(b, c);
    const Vec3Of<DoubleDoubleOf<V>> ac = exact_difference(c, a), ba = exact_difference(a, b);
    const auto error = [](const Vec3Of<MagnitudeOf<V>>& about, const Vec3Of<MagnitudeOf<V>>& side)
        __attribute__((always_inline)) {
        return 0x1p-101 * dot(about, side).value + 0x1p-1000 * (1 + total(about) + total(side));
    };
    Weights<V> weights{{dot(about_c, cb).hi, dot(about_a, ac).hi, dot(about_a, ba).hi},
                       {error(about_c_size, magnitudes(cb)), error(about_a_size, magnitudes(ac)),
                        error(about_a_size, magnitudes(ba))},
                       {},
                       {}};
    weights.compare();
    return weights;
}

/// Whether a triangle that is certainly hit is hit behind the plane of the nearest hit. lead: where
/// it is certainly hit, receives about how far.
template <class V>
OVC_INLINE MaskOf<V> hit_behind(const Sides<V>& sides, const Weights<V>& w, V& lead) {
    V sum{}, size{}, error{}, weights{};
    for (int i = 0; i < 3; ++i) {
        const V weight = magnitude(w.value[i]), share = weight * sides.distance[i];
        weights += weight;
        sum += share;
        size += magnitude(share);
        error += (weight + w.error[i]) * sides.error[i] + w.error[i] * magnitude(sides.distance[i]);
    }
    lead = w.is_inside ? sum / weights : lead;
    return w.is_inside & (sum > 2 * error + (0x1p-50 * size + 0x1p-1000));
}

/// V is a vector of some of the lanes.
template <class V>
class CullSome {
public:
    OVC_INLINE CullSome(const CullRay& ray, const CullLanes& lanes, int lane)
        : ray_(ray), lanes_(lanes), lane_(lane), corners_(lanes, lane), lost_{}, kept_{} {
        __builtin_memcpy(&loses_ties_, lanes.key + lane, sizeof(V));
        loses_ties_ = loses_ties_ >= ray.key;
    }

    /// Returns the bits of the lanes that are left. lead: as in CullLanes.
    OVC_INLINE uint32_t left(V& lead) {
        if (ray_.has_hit && ray_.support_count > 0) {
            lost_ = corners_.has(ray_, ray_.support[0]) & corners_.has(ray_, ray_.support[1]) &
                    loses_ties_;
            if (are_all_lost())
                return 0;
        }
        // A corner that is shared is in range.
        kept_ = corners_.may_be_out_of_range() & ~lost_;
        const bool has_plane = ray_.has_hit && ray_.has_plane;
        Sides<V> sides;
        if (has_plane)
            find_sides_in_integers(sides);
        if (are_all_lost())
            return 0;
        const TestInDoubles<V> test = test_in_doubles<V>(ray_, lanes_, lane_);
        lead = test.t;
        lost_ |= test.is_missed;
        if (ray_.has_hit)
            lost_ |= test.weights.is_inside & is_later(test);
        if (has_plane && !are_all_lost()) {
            lead = V{}; // of those in doubt
            find_sides_closely(sides);
            lost_ |= hit_behind(sides, test.weights, lead);
        }
        if (bits_of<V>(~(lost_ | test.weights.is_inside)) != 0) {
            const Weights<V> closely = weights_closely(ray_, corners_);
            lost_ |= closely.is_outside;
            if (has_plane)
                lost_ |= hit_behind(sides, closely, lead);
        }
        return bits_of<V>(~lost_ | kept_);
    }

private:
    OVC_INLINE bool are_all_lost() const { return bits_of<V>(~lost_ | kept_) == 0; }

    OVC_INLINE MaskOf<V> is_later(const TestInDoubles<V>& test) const {
        const V gap = (test.t - ray_.t) - ray_.t_low, low = all_lanes<V>(ray_.t_low);
        return gap > test.t_error + (ray_.t_error + 0x1p-52 * magnitude(low));
    }

    OVC_INLINE void find_sides_in_integers(Sides<V>& sides) {
        for (int i = 0; i < 3; ++i)
            if (ray_.has_units)
                find_side_in_integers(sides, ray_, Offset<V>(ray_, corners_, i), i);
            else
                sides.leave_open(i);
        lose_by(sides);
    }
    OVC_INLINE void find_sides_closely(Sides<V>& sides) {
        if (bits_of<V>(~lost_ & ~sides.all_known()) == 0)
            return;
        for (int i = 0; i < 3; ++i)
            find_side_closely(sides, ray_, corners_, Offset<V>(ray_, corners_, i), i);
        lose_by(sides);
    }
    OVC_INLINE void lose_by(const Sides<V>& sides) {
        lost_ |= sides.all_behind() | (sides.none_before() & loses_ties_);
    }

    const CullRay& ray_;
    const CullLanes& lanes_;
    const int lane_;
    const Corners<V> corners_;
    MaskOf<V> loses_ties_, lost_, kept_; // kept_: left in any case
};

template <class V>
OVC_INLINE uint32_t cull_by(const CullRay& ray, CullLanes& lanes) {
    uint32_t left = 0;
    for (int lane = 0; lane < CullLanes::kCount; lane += int(sizeof(V) / sizeof(double))) {
        V lead{};
        left |= CullSome<V>(ray, lanes, lane).left(lead) << lane;
        __builtin_memcpy(lanes.lead + lane, &lead, sizeof(V));
    }
    return left;
}

} // namespace ovc
