// SPDX-License-Identifier: Apache-2.0
// plan_streamed(): tells what save_streamed() would make, for two looks at every triangle.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "gpu/gl/egl_context.h"
#include "plugin/overcast.h"
#include "plugin/plan/two_level_options.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>

namespace ovc {

/// Returns the plan of what save_streamed() would write within host_bytes, with `seconds` left to
/// the caller. Its own memory stays below them, too: a quarter for the sample, and 32,768 triangles
/// in cubes. host_bytes of the plan: the most that tracing takes of as many. Errors: those of
/// save_streamed(), as far as they can be told. Throws Cancelled when `progress` or the source say
/// so.
Result<ovc_plan> plan_streamed(TriangleSource& source, uint64_t host_bytes,
                               const TwoLevelOptions& options, const DeviceInfo& device,
                               BuildProgress* progress = nullptr);

} // namespace ovc
