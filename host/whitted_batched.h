// SPDX-License-Identifier: Apache-2.0
// The batched renderer: Whitted's shading over a backend that takes many rays at once.
// Based on: Lee 2006 (thesis), section 3.5, algorithm 5.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/backend.h"

#include <cstdint>
#include <functional>

namespace ovc {

struct WhittedOptions {
    /// Reflections and refractions in a row; the last surface shows its own color alone.
    uint32_t max_depth = 5;
    bool shadows = true;
    /// The most rays a backend gets at once, but for those of a single pixel. Bounds host memory:
    /// at most about three times as many rays wait.
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

/// Renders into `image`, whose size counts; pixels not begun have alpha 0. The same scene, camera
/// and hits give the same pixels bit for bit, whatever the batch size and the number of threads.
Result<RenderReport> render_batched(const Scene& scene, const Camera& camera, Backend& backend,
                                    const WhittedOptions& options, const RenderObserver& observe,
                                    Image& image);

} // namespace ovc
