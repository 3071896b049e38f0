// SPDX-License-Identifier: Apache-2.0
// LocalRay: a ray in the frame of the top-level tree, as the kernel takes it
// (docs/design/numerics.md, "Frames"). local_ray() is the counterpart of local_ray() in
// shaders/rebase_doubles.glsl; it runs on the CPU so that only 32 bytes a ray go to the GPU.
#pragma once

#include "core/exact/triangle.h"
#include "gpu/frame/portal.h"
#include "kdtree/partition.h"
#include "shaders/layout.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace ovc {

/// A ray in the layout of shaders/layout.h.
struct LocalRay {
    vec3 org;      // where it enters the box; t = 0
    float t_end;   // OVC_NO_RAY if it meets no box; OVC_UNDECIDABLE if double cannot say where
    vec3 dir;      // its largest component is 1 or -1
    uint32_t asks; // number of a triangle not to see, or OVC_SKIPS_NONE; plus OVC_RAY_ANY_HIT
};
static_assert(sizeof(LocalRay) == OVC_LOCAL_RAY_TEXELS * 16);

/// A ray for passes in which not all pages are in the pool.
struct ResumedRay {
    LocalRay ray;
    uint32_t waited_for; // the key of a link, or 0
    uint32_t zeros[3];
};
static_assert(sizeof(ResumedRay) == OVC_RESUMED_RAY_TEXELS * 16);

/// The way back from a local t: the ray's own t = enter + local t / speed.
struct LocalTime {
    double enter = 0;
    double speed = 1;

    /// Returns a t of the ray that is not after the local t, whose place a kernel may have counted
    /// with a rounding (shaders/times.glsl). Minus infinity for a NaN, and for what is before all.
    double begin_of(float local) const {
        const double t = local, error = std::abs(t) * 0x1p-22 + 0x1p-28;
        return t > -1e30 ? enter + (t - error) / speed : -std::numeric_limits<double>::infinity();
    }
};

/// Returns the ray in the frame of a leaf, from where it enters the leaf's box, and sets `time`.
/// leaf: its box and frame. skip, any_hit: as in LocalRay::asks.
LocalRay local_ray(const Leaf& leaf, const Ray& ray, uint32_t skip, bool any_hit, LocalTime& time);

/// Returns the ray in the frame behind a portal, likewise.
LocalRay local_ray(const Portal& portal, const Ray& ray, uint32_t skip, bool any_hit,
                   LocalTime& time);

} // namespace ovc
