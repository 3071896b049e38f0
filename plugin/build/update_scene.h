// SPDX-License-Identifier: Apache-2.0
// update_scene(): brings a built scene up to date with its soup.
#pragma once

#include "core/changes.h"
#include "plugin/build/built_scene.h"
#include "plugin/plan/two_level_options.h"

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// Counts of the pages that an update has changed.
struct PageChanges {
    std::vector<uint32_t> was;     // for each page: its number before; kNone: it is new
    std::vector<uint32_t> changed; // those of before whose units are others now
    uint64_t refitted = 0;         // pages
    uint64_t rebuilt = 0;
};

/// Updates the scene of a soup that has changed so. Meshes whose corners stay keep their pages:
/// where only instances are placed anew, the top-level tree alone is built. Returns nothing where
/// the scene must be built anew; it is then of no use, as after a throw. Throws Cancelled when
/// `progress` is told to stop.
std::optional<PageChanges> update_scene(BuiltScene& scene, const Changes& changes,
                                        const TwoLevelOptions& options, const MemoryPlan& plan,
                                        BuildProgress* progress);

} // namespace ovc
