// SPDX-License-Identifier: Apache-2.0
// The batched renderer hands the backend many rays of one kind at once.
// Based on: Lee 2006 (thesis), section 3.5, algorithm 5.
#pragma once

#include "host/camera/camera_rays.h"
#include "host/render/render.h"
#include "host/render/sight.h"

namespace ovc {

/// Camera rays, and the film that they are rendered onto.
struct RenderTask {
    const Integrator& integrator;
    const CameraRays& camera;
    const Sight& sight;
    const RenderObserver& observe;
    Film& film;
};

/// Renders the camera's rays onto the film. batch_rays: at least 1. The report lacks `seconds` and
/// `seconds_cpu`.
Result<RenderReport> render_batched(const RenderTask& task, Backend& backend, size_t batch_rays);

} // namespace ovc
