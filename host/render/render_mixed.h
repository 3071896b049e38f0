// SPDX-License-Identifier: Apache-2.0
// The mixed renderer: camera rays, reflections, refractions, bounces and shadow rays are under way
// together in one stream. Based on: Lee 2006 (thesis), section 3.5, algorithm 6.
#pragma once

#include "host/camera/camera_rays.h"
#include "host/render/render.h"
#include "host/render/sight.h"

namespace ovc {

/// Does the same as render_batched(), to the same bits on the film.
Result<RenderReport> render_mixed(const Integrator& integrator, size_t lights,
                                  const CameraRays& camera, const Sight& sight, Backend& backend,
                                  const RenderObserver& observe, Film& film);

} // namespace ovc
