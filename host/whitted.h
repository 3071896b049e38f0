// SPDX-License-Identifier: Apache-2.0
// Whitted's renderer: what its batched and its mixed form share.
#pragma once

#include "core/scene.h"
#include "host/shade.h"

#include <cstddef>
#include <cstdint>
#include <functional>

namespace ovc {

struct WhittedOptions {
    /// Reflections and refractions in a row; the last surface shows its own color alone.
    uint32_t max_depth = 5;
    bool shadows = true;
    /// Batched: the most rays a backend gets at once, but for those of a single pixel. Bounds host
    /// memory: at most about three times as many rays wait.
    size_t batch_rays = size_t(1) << 20;
};

struct RayCounts {
    uint64_t primary = 0;
    uint64_t shadow = 0;
    uint64_t reflection = 0;
    uint64_t refraction = 0;

    uint64_t total() const { return primary + shadow + reflection + refraction; }
    RayCounts& operator+=(const RayCounts& other) {
        primary += other.primary;
        shadow += other.shadow;
        reflection += other.reflection;
        refraction += other.refraction;
        return *this;
    }
};

struct RenderReport {
    RayCounts rays;
    double seconds_trace = 0; // inside the backend
    double seconds_shade = 0; // the rest
    uint64_t pixels_done = 0;
    bool complete = false; // false: `observe` stopped it; what was done is in the image
};

/// Called after every answer of the backend, with what has been done so far; false stops the
/// rendering.
using RenderObserver = std::function<bool(const RenderReport&)>;

/// A reflection or refraction that adds less than this to its pixel is not followed; an 8-bit image
/// would not show it. The shares of a pixel's paths add up to at most 1, so it never has more than
/// 512 of them at a time.
inline constexpr float kLeastWeight = 1 / 512.0f;

/// What a ray is for: the share of its pixel's color that it decides.
struct Path {
    uint32_t pixel;
    uint32_t depth; // reflections and refractions that led here
    vec3 weight;
};

/// The weights of the rays that leave a surface; 0: is not followed.
struct Children {
    vec3 mirror{0};
    vec3 through{0};
};

/// Divides the weight of the path that `ray` came along among the surface's own color, which keeps
/// what is not followed, and the two rays that may leave it.
Children split_weight(Path& path, const Ray& ray, const SurfacePoint& surface, uint32_t max_depth);

/// Whether a shadow ray may have to look for more than one surface: light passes some material or
/// mesh.
bool lets_light_through(const Scene& scene);

/// Dims the light `left` of a shadow ray by the surface it hit, the `depth`th in its way, and moves
/// the ray behind that. False: it ends here; what is left of the light arrives, and is not 0 only
/// where the light lies in that surface.
bool pass_glass(const Scene& scene, const Light& light, const WhittedOptions& options,
                uint32_t depth, const Hit& hit, Ray& ray, vec3& left);

} // namespace ovc
