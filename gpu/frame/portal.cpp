// SPDX-License-Identifier: Apache-2.0
// Packs portals as texels, and takes rays through them in double.
#include "gpu/frame/portal.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <limits>

namespace ovc {

double Portal::stretch() const {
    double most = 0;
    for (const dvec3& row : rows)
        most = std::max(most, std::abs(row.x) + std::abs(row.y) + std::abs(row.z));
    return most;
}

PreparedRay Portal::local_ray(const PreparedRay& p) const {
    PreparedRay local = p;
    local.ray.org = to_local(p.ray.org);
    local.ray.dir = to_local_direction(p.ray.dir);
    local.inv_dir = 1.0 / local.ray.dir;
    return local;
}

/// Returns the float next to x on the way to `towards`, or x if it is one. Kernels may take numbers
/// below the least normal float for 0, so none is returned.
static float to_float(double x, float towards) {
    const float nearest = float(x);
    const bool is_outside = towards < 0 ? nearest <= x : nearest >= x;
    const float result = is_outside ? nearest : std::nextafter(nearest, towards);
    const float least = std::numeric_limits<float>::min();
    if (result == 0 || std::abs(result) >= least)
        return result;
    return (result < 0) == (towards < 0) ? std::copysign(least, towards) : 0;
}

/// Returns the least box around this one whose corners are floats.
static Box in_floats(const Box& box) {
    Box floats;
    for (int axis = 0; axis < 3; ++axis) {
        floats.lo[axis] = to_float(box.lo[axis], -INFINITY);
        floats.hi[axis] = to_float(box.hi[axis], INFINITY);
    }
    return floats;
}

Portal portal_into(const Frame& frame, const Box& box, const Transform* transform) {
    Portal portal;
    portal.origin = transform ? (*transform)(frame.origin) : frame.origin;
    portal.rows = *inverse_matrix(or_identity(transform));
    for (dvec3& row : portal.rows)
        row *= frame.scale;
    portal.box = in_floats({frame.to_local(box.lo), frame.to_local(box.hi)});
    portal.bounds = placed_box(box, transform);
    return portal;
}

std::vector<uvec4> pack_portals(std::span<const Portal> portals) {
    std::vector<uvec4> texels;
    texels.reserve(portals.size() * OVC_PORTAL_TEXELS);
    for (const Portal& portal : portals) {
        std::array<double, 12> numbers{};
        auto next = numbers.begin();
        for (const dvec3& v : {portal.origin, portal.rows[0], portal.rows[1], portal.rows[2]})
            for (int axis = 0; axis < 3; ++axis)
                *next++ = v[axis];
        for (size_t i = 0; i < numbers.size(); i += 2) {
            const auto a = std::bit_cast<uint64_t>(numbers[i]);
            const auto b = std::bit_cast<uint64_t>(numbers[i + 1]);
            texels.emplace_back(uint32_t(a), uint32_t(a >> 32), uint32_t(b), uint32_t(b >> 32));
        }
        const auto bits = [](double x) { return std::bit_cast<uint32_t>(float(x)); };
        const auto& [lo, hi] = portal.box;
        texels.emplace_back(bits(lo.x), bits(lo.y), bits(lo.z), bits(hi.x));
        texels.emplace_back(bits(hi.y), bits(hi.z), portal.tree, portal.first_number);
    }
    return texels;
}

} // namespace ovc
