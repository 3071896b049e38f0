// SPDX-License-Identifier: Apache-2.0
// From a soup to the scene that a budget allows: restored where that will do, else built.
#pragma once

#include "core/system/log.h"
#include "plugin/build/built_scene.h"
#include "plugin/plan/two_level_options.h"

namespace ovc {

/// The scene of a soup under its plan_memory(), which check_budget() lets pass: the pool holds the
/// top-level tree and the largest page. The soup and options.saved must outlive it.
Result<BuiltScene> build_scene(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& plan, const LogSink& log,
                               BuildProgress* progress = nullptr);

/// The bytes of a plan's pool that are left for the top-level tree and pages; the others are for
/// portals and for marks of active pages.
uint64_t room_for_pool(const BuiltScene& scene, const TwoLevelOptions& options,
                       const MemoryPlan& plan);

/// Sets what leaves may be, of all that is cut, where triangles are taken.
void set_limits(BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan);

} // namespace ovc
