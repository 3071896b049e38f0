// SPDX-License-Identifier: Apache-2.0
// Rays go into the scene's frame in double, and are then rounded.
#include "plugin/thesis/frame_ray.h"

#include "shaders/layout.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc::thesis {
namespace {

uint32_t index_of(const Leaf& whole, TriangleId id) {
    if (id.mesh == kNone)
        return kNone;
    const auto at = std::lower_bound(whole.triangles.begin(), whole.triangles.end(), id);
    return at != whole.triangles.end() && *at == id ? uint32_t(at - whole.triangles.begin())
                                                    : kNone;
}

Interval inside(const Leaf& whole, const PreparedRay& p) {
    return clip(p, whole.box, p.ray.t_min, p.ray.t_max);
}

} // namespace

FrameRay frame_ray(const Leaf& whole, const PreparedRay& p, bool& decidable) {
    assert(whole.frame.scale > 0);
    // From too far away, rounding may make the ray miss even the box.
    decidable = p.margin(whole.box) <= 0x1p-20 * max_component(whole.box.extent());
    if (!decidable)
        return {};
    const Interval stretch = inside(whole, p);
    if (stretch.empty())
        return {};
    const dvec3 from_origin = p.ray.org - whole.frame.origin;
    const dvec3 travelled = p.ray.dir * stretch.enter;
    const double reach = max_component(glm::max(glm::abs(from_origin), glm::abs(travelled)));
    const double longest = std::abs(p.ray.dir[p.kz]);
    const double length = (stretch.exit - stretch.enter) * longest * whole.frame.scale;
    // The conditions are written so that a NaN is not decidable either.
    decidable = reach * whole.frame.scale <= OVC_MAX_LEAF_SIZES && std::isfinite(length) &&
                std::isnormal(longest * whole.frame.scale);
    if (!decidable)
        return {};
    return {vec3((from_origin + travelled) * whole.frame.scale),
            std::nextafter(float(length), INFINITY), vec3(p.ray.dir / longest),
            index_of(whole, p.skip)};
}

double world_t(const Leaf& whole, const PreparedRay& p, float t_frame) {
    return inside(whole, p).enter +
           double(t_frame) / (std::abs(p.ray.dir[p.kz]) * whole.frame.scale);
}

} // namespace ovc::thesis
