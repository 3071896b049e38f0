// SPDX-License-Identifier: Apache-2.0
// The kernel's change of a ray's frame in pairs of floats, as C++.
#pragma once

#include "core/vec.h"
#include "gpu/frame/portal.h"
#include "gpu/trace/sent_rays.h"

namespace ovc {

/// A number as the sum of two floats.
struct FloatPairValue {
    float hi = 0, lo = 0;
};

/// LocalRay of shaders/local_ray.glsl.
struct Rebased {
    vec3 org, dir;
    float t_end = 0;
    bool meets = false;
    bool decidable = false;
    FloatPairValue enter, speed; // the ray's t, times 2^exponent, is enter + t / speed
    float early = 0;
    int exponent = 0; // of the largest component of the ray's direction
};
Rebased rebased(const RayState& ray, const Portal& portal);

/// moved() of shaders/times_float_pairs.glsl.
float moved(float t, const Rebased& from, const Rebased& to, float& error);

} // namespace ovc
