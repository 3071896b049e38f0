// SPDX-License-Identifier: Apache-2.0
// The batched renderer: Whitted's shading over a backend that takes many rays at once.
// Based on: Lee 2006 (thesis), section 3.5, algorithm 5.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/backend.h"
#include "host/whitted.h"

namespace ovc {

/// Renders into `image`, whose size counts; pixels not begun have alpha 0. The same scene, camera
/// and hits give the same pixels bit for bit, whatever the batch size and the number of threads.
Result<RenderReport> render_batched(const Scene& scene, const Camera& camera, Backend& backend,
                                    const WhittedOptions& options, const RenderObserver& observe,
                                    Image& image);

} // namespace ovc
