// SPDX-License-Identifier: Apache-2.0
// POV-Ray's documentation (section 3.4.7.5.5, "Warp") says what each does; what it leaves open was
// found by asking povray for values.
#include "core/texture/warp.h"

#include <algorithm>
#include <cmath>

namespace ovc {

namespace {

dvec3 affine(const TextureStep& step, const dvec3& at) {
    const dvec4 p(at, 1);
    return {glm::dot(step.rows[0], p), glm::dot(step.rows[1], p), glm::dot(step.rows[2], p)};
}

dvec3 repeated(const TextureStep& step, dvec3 at) {
    for (int axis = 0; axis < 3; ++axis) {
        const double period = step.rows[0][axis];
        if (!(std::abs(period) > 0))
            continue;
        const double times = std::floor(at[axis] / period);
        at[axis] -= times * period;
        if (std::fmod(times, 2) != 0)
            for (int other = 0; other < 3; ++other)
                if (step.rows[2][other] < 0)
                    at[other] = (other == axis ? period : 0) - at[other];
        at += times * dvec3(step.rows[1]);
    }
    return at;
}

/// Within the radius a point moves away from the center, or towards it where the hole pushes.
dvec3 drawn_by_hole(const TextureStep& step, const dvec3& at) {
    const dvec3 center(step.rows[0]);
    const double radius = step.rows[0].w, strength = step.rows[1].x, falloff = step.rows[1].y;
    const dvec3 way = at - center;
    const double length = glm::length(way);
    if (!(length < radius))
        return at;
    const double power = std::min(std::pow((radius - length) / radius, falloff) * strength, 1.0);
    return at + (step.rows[1].z != 0 ? -power : power) * way;
}

} // namespace

dvec3 warped(const TextureStep& step, const dvec3& at) {
    switch (step.kind) {
    case TextureStep::Kind::Turbulence: {
        const dvec4 &first = step.rows[0], &second = step.rows[1];
        return at + dvec3(first) * turbulence(at, {first.w, second.x, uint64_t(second.y)});
    }
    case TextureStep::Kind::Repeat:
        return repeated(step, at);
    case TextureStep::Kind::BlackHole:
        return drawn_by_hole(step, at);
    default:
        return affine(step, at);
    }
}

} // namespace ovc
