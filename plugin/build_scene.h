// SPDX-License-Identifier: Apache-2.0
// From a soup to the scene that a budget allows: restored where that will do, else built.
#pragma once

#include "core/log.h"
#include "plugin/built_scene.h"
#include "plugin/two_level_options.h"

namespace ovc {

/// The scene of a soup under its plan_memory(), which check_budget() lets pass: the pool holds
/// level 1 and the largest page. The soup and options.saved must outlive it.
Result<BuiltScene> build_scene(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& plan, const LogSink& log,
                               BuildProgress* progress = nullptr);

/// The bytes of the pool that level 1 takes.
uint64_t table_bytes(const BuiltScene& scene, const TwoLevelOptions& options);

} // namespace ovc
