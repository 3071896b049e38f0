// SPDX-License-Identifier: Apache-2.0
// Re-basing, and when it is not exact enough.
#include "plugin/rebase.h"

#include "shaders/layout.h"

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

/// Farther than this from the leaf, in leaf sizes, the place of entry is off by more than 1/64 of a
/// float rounding.
constexpr double kMostLeafSizes = 0x1p21;

/// What the leaf calls the triangle, or OVC_NO_TRIANGLE where it does not hold it.
uint32_t index_in(const Leaf& leaf, TriangleId id) {
    if (id.mesh == kNone)
        return OVC_NO_TRIANGLE;
    const auto at = std::lower_bound(leaf.triangles.begin(), leaf.triangles.end(), id);
    return at != leaf.triangles.end() && *at == id ? uint32_t(at - leaf.triangles.begin())
                                                   : OVC_NO_TRIANGLE;
}

} // namespace

LocalRay no_ray() {
    return {vec3(0), -1, vec3(0, 0, 1), OVC_NO_TRIANGLE};
}

LocalRay rebase(const Leaf& leaf, const PreparedRay& p, bool& decidable) {
    decidable = true;
    const Interval inside = clip(p, leaf.box, p.ray.t_min, p.ray.t_max);
    if (inside.empty())
        return no_ray();
    const dvec3 from_origin = p.ray.org - leaf.frame.origin;
    const dvec3 travelled = p.ray.dir * inside.enter;
    const double reach = max_component(glm::max(glm::abs(from_origin), glm::abs(travelled)));
    const double longest = std::abs(p.ray.dir[p.kz]);
    const double length = (inside.exit - inside.enter) * longest * leaf.frame.scale;
    // Written so that a NaN is not decidable either.
    decidable = reach * leaf.frame.scale <= kMostLeafSizes && std::isfinite(length) &&
                std::isnormal(longest * leaf.frame.scale);
    if (!decidable)
        return no_ray();
    return {vec3((from_origin + travelled) * leaf.frame.scale),
            std::nextafter(float(length), INFINITY), vec3(p.ray.dir / longest),
            index_in(leaf, p.skip)};
}

double world_t(const Leaf& leaf, const PreparedRay& p, float t_local) {
    const Interval inside = clip(p, leaf.box, p.ray.t_min, p.ray.t_max);
    return inside.enter + double(t_local) / (std::abs(p.ray.dir[p.kz]) * leaf.frame.scale);
}

} // namespace ovc
