// SPDX-License-Identifier: Apache-2.0
// The mixed renderer: Whitted's shading inside of a stream, in which camera rays, reflections,
// refractions and shadow rays are under way together. Based on: Lee 2006 (thesis), section 3.5,
// algorithm 6.
#pragma once

#include "core/image.h"
#include "core/result.h"
#include "core/scene.h"
#include "host/backend.h"
#include "host/whitted.h"

namespace ovc {

/// As render_batched(), and the same picture but for the last bits of its sums. The same scene,
/// camera and hits give the same pixels bit for bit, in whatever order the answers come.
Result<RenderReport> render_mixed(const Scene& scene, const Camera& camera, Backend& backend,
                                  const WhittedOptions& options, const RenderObserver& observe,
                                  Image& image);

} // namespace ovc
