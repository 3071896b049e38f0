// SPDX-License-Identifier: Apache-2.0
// A ray in the frame of the top-level tree, as the kernel takes it (docs/design/numerics.md,
// "Frames"): the counterpart in C++ of local_ray() in shaders/portals.glsl, so that a ray goes over
// as 32 bytes.
#pragma once

#include "core/exact/triangle.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <cstdint>

namespace ovc {

/// In the layout of shaders/layout.h.
struct LocalRay {
    vec3 org;    // where it enters the box; t = 0
    float t_end; // OVC_NO_RAY where it meets no box, OVC_UNDECIDABLE where double cannot say where
    vec3 dir;    // the largest component 1 or -1
    uint32_t
        asks; // number of the triangle it does not see, or OVC_SKIPS_NONE; OVC_RAY_ANY_HIT added
};
static_assert(sizeof(LocalRay) == OVC_LOCAL_RAY_TEXELS * 16);

/// Where not all pages are in the pool.
struct ResumedRay {
    LocalRay ray;
    uint32_t waited_for; // the key of a link, or 0
    uint32_t zeros[3];
};
static_assert(sizeof(ResumedRay) == OVC_RESUMED_RAY_TEXELS * 16);

/// How to come back: t of the ray = enter + local t / speed.
struct LocalTime {
    double enter = 0;
    double speed = 1;
};

/// leaf: its box and frame. skip, any_hit: what LocalRay::asks says.
LocalRay local_ray(const Leaf& leaf, const Ray& ray, uint32_t skip, bool any_hit, LocalTime& time);

} // namespace ovc
