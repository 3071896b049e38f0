// SPDX-License-Identifier: Apache-2.0
// build_scene(): makes the scene of a soup that a budget allows, from saved bytes where it can.
#pragma once

#include "core/system/log.h"
#include "plugin/build/built_scene.h"
#include "plugin/plan/two_level_options.h"

namespace ovc {

/// Returns the scene of a soup under its plan_memory(), which check_budget() has let pass. The
/// plan's pool has room for the top-level tree and the largest page. The soup and options.saved
/// must outlive the scene. Error: there are too many pages or instances, or a page of one triangle
/// does not fit. Throws Cancelled when `progress` is told to stop.
Result<BuiltScene> build_scene(const Soup& soup, const TwoLevelOptions& options,
                               const MemoryPlan& plan, const LogSink& log,
                               BuildProgress* progress = nullptr);

/// Returns the scene that options.store reads. Error of the kind OverBudget: the plan's pool has no
/// room for the tree and the largest page of what was saved, or the store's budget is too small;
/// the sentence names the smallest that works.
Result<BuiltScene> open_scene(const Soup& soup, const TwoLevelOptions& options,
                              const MemoryPlan& plan, const DeviceInfo& device, const LogSink& log);

/// Returns the smallest budget with which a scene can be traced whose tree is built over the roots
/// of its pages, as that of a scene on a disk is.
uint64_t smallest_budget(const BuiltScene& scene, const TwoLevelOptions& options,
                         const DeviceInfo& device);

/// Returns the bytes of the plan's pool that portals and marks of active pages leave to the
/// top-level tree and pages.
uint64_t room_for_pool(const BuiltScene& scene, const TwoLevelOptions& options,
                       const MemoryPlan& plan);

/// Builds the top-level tree over the scene's pages, a smaller one where the pool has no room for
/// all of them. Returns false where it has no room for the tree and the largest page.
bool add_tree(BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan);

/// Sets the limits on leaves of the scene and of its shared meshes, whose triangles are taken.
void set_limits(BuiltScene& scene, const TwoLevelOptions& options, const MemoryPlan& plan);

} // namespace ovc
