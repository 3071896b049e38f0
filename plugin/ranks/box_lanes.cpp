// SPDX-License-Identifier: Apache-2.0
// The loops over lanes have no branches, so that a compiler makes one vector of them; each is
// compiled for several widths, and all compute the same bits.
#include "plugin/ranks/box_lanes.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstddef>

namespace ovc {
namespace {

using Eight = BoxLanes::Eight;
using Entries = BoxLanes::Entries;
constexpr size_t kLanes = BoxLanes::kLanes;

constexpr Eight nowhere() {
    Eight lanes{};
    for (size_t side = 0; side < 6; ++side)
        for (double& of_box : lanes.sides[side])
            of_box = side < 3 ? kNoEntry : -kNoEntry;
    return lanes;
}

/// Sets entries[i] to the smallest entry of the ray into box i of any of the lanes.
[[gnu::always_inline]] inline void enter_ray(const EnteringRay& ray, std::span<const Eight> all,
                                             Entries& entries) {
    for (double& entry : entries)
        entry = kNoEntry;
    for (const Eight& lanes : all) {
        const double* in[3];
        const double* out[3];
        for (int axis = 0; axis < 3; ++axis) {
            in[axis] = lanes.sides[ray.goes_down(axis) ? 3 + axis : axis];
            out[axis] = lanes.sides[ray.goes_down(axis) ? axis : 3 + axis];
        }
        for (size_t i = 0; i < kLanes; ++i) {
            const double entry =
                ray.entry({in[0][i], in[1][i], in[2][i]}, {out[0][i], out[1][i], out[2][i]});
            entries[i] = entry < entries[i] ? entry : entries[i];
        }
    }
}

/// Sets entries[i] to a lower bound of the entries of the packet's rays into box i.
[[gnu::always_inline]] inline void enter_packet(const RayPacket& packet, const Eight& lanes,
                                                Entries& entries) {
    constexpr double kLess = 1 - 0x1p-50, kMore = 1 + 0x1p-50; // as in EnteringRay, and one more
    Entries near, far;
    for (size_t i = 0; i < kLanes; ++i)
        near[i] = packet.min_t, far[i] = packet.max_t;
    for (int axis = 0; axis < 3; ++axis) {
        const RayPacket::Axis& along = packet.axes[axis];
        if (along.sign == 0)
            continue;
        const double* const in = lanes.sides[along.sign > 0 ? axis : 3 + axis];
        const double* const out = lanes.sides[along.sign > 0 ? 3 + axis : axis];
        for (size_t i = 0; i < kLanes; ++i) {
            const double to_in = along.sign * in[i] - along.a;
            const double to_out = along.sign * out[i] - along.b;
            const double enters =
                to_in * (to_in > 0 ? along.min_inv * kLess : along.max_inv * kMore);
            const double leaves =
                to_out * (to_out > 0 ? along.max_inv * kMore : along.min_inv * kLess);
            near[i] = enters > near[i] ? enters : near[i];
            far[i] = leaves < far[i] ? leaves : far[i];
        }
    }
    for (size_t i = 0; i < kLanes; ++i)
        entries[i] = near[i] <= far[i] ? near[i] : kNoEntry;
}

struct Kernels {
    void (*enter_ray)(const EnteringRay&, std::span<const Eight>, Entries&);
    void (*enter_packet)(const RayPacket&, const Eight&, Entries&);
};

#define OVC_BOX_KERNELS(name, target)                                                              \
    target void ray_##name(const EnteringRay& ray, std::span<const Eight> all, Entries& entries) { \
        enter_ray(ray, all, entries);                                                              \
    }                                                                                              \
    target void packet_##name(const RayPacket& packet, const Eight& lanes, Entries& entries) {     \
        enter_packet(packet, lanes, entries);                                                      \
    }

OVC_BOX_KERNELS(anywhere, )
#if defined(__x86_64__)
OVC_BOX_KERNELS(avx2, [[gnu::target("avx2")]])
OVC_BOX_KERNELS(avx512, [[gnu::target("avx512f,prefer-vector-width=512")]])
#endif
#undef OVC_BOX_KERNELS

/// Returns the widest that the processor has.
Kernels widest() {
#if defined(__x86_64__)
    if (__builtin_cpu_supports("avx512f"))
        return {ray_avx512, packet_avx512};
    if (__builtin_cpu_supports("avx2"))
        return {ray_avx2, packet_avx2};
#endif
    return {ray_anywhere, packet_anywhere};
}

const Kernels kernels = widest();

} // namespace

RayPacket::RayPacket(std::span<const Ray> rays) {
    static_assert(sizeof(Ray) == 8 * sizeof(double));
    // org, t_min, dir, t_max. A product with 0 is 0 for a finite number, and else NaN.
    double lo[8], hi[8], zeros[8] = {};
    for (size_t k = 0; k < 8; ++k)
        lo[k] = kNoEntry, hi[k] = -kNoEntry;
    bool are_ordered = true;
    for (const Ray& ray : rays) {
        const double* const numbers = &ray.org.x;
        for (size_t k = 0; k < 8; ++k) {
            lo[k] = numbers[k] < lo[k] ? numbers[k] : lo[k];
            hi[k] = numbers[k] > hi[k] ? numbers[k] : hi[k];
            zeros[k] += numbers[k] * 0;
        }
        are_ordered &= ray.t_min <= ray.t_max;
    }
    min_t = lo[3], max_t = hi[7];
    bool are_finite = true, is_one_way = false;
    for (size_t k = 0; k < 7; ++k)
        are_finite &= zeros[k] == 0;
    for (int axis = 0; axis < 3; ++axis) {
        constexpr double kShort = 1e-150; // so that reciprocals stay far from infinity
        const double min_dir = lo[4 + axis], max_dir = hi[4 + axis];
        Axis& along = axes[axis];
        along.sign = min_dir > kShort ? 1 : max_dir < -kShort ? -1 : 0;
        is_one_way |= along.sign != 0;
        along.a = along.sign > 0 ? hi[axis] : -lo[axis];
        along.b = along.sign > 0 ? lo[axis] : -hi[axis];
        along.min_inv = 1 / std::max(std::abs(min_dir), std::abs(max_dir));
        along.max_inv = 1 / std::min(std::abs(min_dir), std::abs(max_dir));
    }
    is_bounded_ = are_ordered && are_finite && is_one_way;
}

/// Appends the box. size: how many there are.
static void append(const Box& box, size_t size, std::vector<Eight>& lanes) {
    const size_t lane = size % kLanes;
    if (lane == 0)
        lanes.push_back(nowhere());
    for (int axis = 0; axis < 3; ++axis) {
        lanes.back().sides[axis][lane] = box.lo[axis];
        lanes.back().sides[3 + axis][lane] = box.hi[axis];
    }
}

BoxLanes::BoxLanes(std::span<const Box> boxes) : boxes_(boxes.size()) {
    for (size_t i = 0; i < boxes.size(); ++i)
        append(boxes[i], i, lanes_);
    for (size_t i = 0; i < lanes_.size(); ++i) {
        Box around;
        for (const Box& box :
             boxes.subspan(i * kLanes, std::min(kLanes, boxes.size() - i * kLanes)))
            around.add(box);
        append(around, i, around_);
    }
}

void BoxLanes::add(const Eight& from, size_t lane) {
    if (boxes_ % kLanes == 0)
        lanes_.push_back(nowhere());
    for (size_t side = 0; side < 6; ++side)
        lanes_.back().sides[side][boxes_ % kLanes] = from.sides[side][lane];
    ++boxes_;
}

double BoxLanes::enter(const EnteringRay& ray) const {
    Entries entries;
    kernels.enter_ray(ray, lanes_, entries);
    for (size_t half = kLanes / 2; half > 0; half /= 2)
        for (size_t i = 0; i < half; ++i)
            entries[i] = entries[i + half] < entries[i] ? entries[i + half] : entries[i];
    return entries[0];
}

/// Calls visit(lane, entry) for the boxes that rays of the packet may enter.
template <class Visit>
static void for_each_entered(const RayPacket& packet, const Eight& lanes, Visit&& visit) {
    Entries entries;
    kernels.enter_packet(packet, lanes, entries);
    for (size_t lane = 0; lane < kLanes; ++lane)
        if (entries[lane] != kNoEntry)
            visit(lane, entries[lane]);
}

double BoxLanes::enter(const RayPacket& packet, BoxLanes& some) const {
    assert(packet.is_bounded());
    some.clear();
    double min = kNoEntry;
    for (size_t i = 0; i < around_.size(); ++i)
        for_each_entered(packet, around_[i], [&](size_t group, double) {
            const Eight& lanes = lanes_[i * kLanes + group];
            for_each_entered(packet, lanes, [&](size_t lane, double entry) {
                min = std::min(min, entry);
                some.add(lanes, lane);
            });
        });
    return min;
}

} // namespace ovc
