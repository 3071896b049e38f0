// SPDX-License-Identifier: Apache-2.0
// The batched renderer: a backend is asked for many rays of one kind at once.
// Based on: Lee 2006 (thesis), section 3.5, algorithm 5.
#pragma once

#include "host/camera/camera_rays.h"
#include "host/render/render.h"

namespace ovc {

/// lights: of which each may ask for a shadow ray. The report lacks times of the whole.
Result<RenderReport> render_batched(const Integrator& integrator, size_t lights,
                                    const CameraRays& camera, Backend& backend, size_t batch_rays,
                                    const RenderObserver& observe, Film& film);

} // namespace ovc
