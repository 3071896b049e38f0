// SPDX-License-Identifier: Apache-2.0
// save_streamed(): builds a scene that need not fit into host memory, and saves it leaf by leaf.
// See docs/decisions/0030-leaves-lie-on-disk.md.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "core/system/log.h"
#include "gpu/gl/egl_context.h"
#include "plugin/out_of_core/streamed_levels.h"
#include "plugin/plan/two_level_options.h"
#include "plugin/structure/triangle_source.h"

#include <cstdint>

namespace ovc {

/// Passes to the sink what save_levels() would, of a scene with the source's meshes, and builds it
/// cell by cell. Error of the kind OverBudget: host_bytes are too few, and the sentence names the
/// smallest number that works; or there are too many leaves. Throws Cancelled when `progress`, the
/// sink, the source or the scratch space say so.
Result<StreamedLevels> stream_levels(const StreamedScene& scene, const TwoLevelOptions& options,
                                     const MemoryPlan& plan, const ByteSink& sink,
                                     BuildProgress* progress = nullptr);

/// Does the same, but builds a scene in memory where that fits into host_bytes. Errors: besides,
/// those of plan_memory() and check_budget().
Result<StreamedLevels> save_streamed(const StreamedScene& scene, const TwoLevelOptions& options,
                                     const DeviceInfo& device, const ByteSink& sink,
                                     const LogSink& log, BuildProgress* progress = nullptr);

} // namespace ovc
