// SPDX-License-Identifier: Apache-2.0
// The mixed renderer: camera rays, reflections, refractions, bounces and shadow rays are under way
// together in one stream. Based on: Lee 2006 (thesis), section 3.5, algorithm 6.
#pragma once

#include "host/render/render_batched.h"

namespace ovc {

/// Does the same as render_batched(), to the same bits on the film.
Result<RenderReport> render_mixed(const RenderTask& task, Backend& backend);

} // namespace ovc
