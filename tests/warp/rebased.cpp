// SPDX-License-Identifier: Apache-2.0
#include "tests/warp/rebased.h"

#include "shaders/layout.h"
#include "tests/warp/glsl.h"

#include <array>
#include <cmath>

namespace ovc_rebased {

using namespace glsl;

#define OVC_FLOAT_PAIRS 1
#include "rebase_as_cpp.inc"

namespace {

// The state of the ray that this thread takes through the portal.
thread_local std::array<uvec4, OVC_RAY_TEXELS> ray_texels;
thread_local std::array<uvec4, OVC_PORTAL_TEXELS> portal_texels;

} // namespace

uvec4 ray_texel(int texel) {
    return ray_texels[size_t(texel)];
}
uvec4 portal_texel(int texel) {
    return portal_texels[size_t(texel)];
}

} // namespace ovc_rebased

namespace ovc {

Rebased rebased(const RayState& ray, const Portal& portal) {
    using namespace ovc_rebased;
    ray_texels = std::bit_cast<std::array<glsl::uvec4, OVC_RAY_TEXELS>>(ray);
    const std::vector<uvec4> packed = pack_portals(std::span(&portal, 1));
    for (size_t i = 0; i < portal_texels.size(); ++i)
        portal_texels[i] = {packed[i].x, packed[i].y, packed[i].z, packed[i].w};
    const ovc_rebased::LocalRay local = local_ray(world_ray(0), portal_at(0));
    const dvec3 dir = glm::abs(ray.ray.dir);
    return {{local.org.x, local.org.y, local.org.z},
            {local.dir.x, local.dir.y, local.dir.z},
            local.t_end,
            local.meets,
            local.decidable,
            {local.times.enter.hi, local.times.enter.lo},
            {local.times.speed.hi, local.times.speed.lo},
            local.early,
            std::ilogb(std::max({dir.x, dir.y, dir.z}))};
}

float moved(float t, const Rebased& from, const Rebased& to, float& error) {
    const auto times = [](const Rebased& ray) {
        return ovc_rebased::Times({ray.enter.hi, ray.enter.lo}, {ray.speed.hi, ray.speed.lo});
    };
    return ovc_rebased::moved(t, times(from), times(to), error);
}

} // namespace ovc
