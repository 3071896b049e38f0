// SPDX-License-Identifier: Apache-2.0
// Restores the scenes that plugin/build/saved_levels.h saves.
#pragma once

#include "core/file/checksum.h"
#include "core/result.h"
#include "plugin/build/built_scene.h"
#include "plugin/leaf_store/leaf_store.h"

#include <functional>
#include <optional>

namespace ovc {

/// Returns the scene that save_levels() wrote of this soup; nothing where the bytes are of another
/// soup, or where a build would now make another scene. limits_for(triangles, unique): as
/// limits_of(). takes_any_limits: LevelsKey::any_limits counts. Lists and pages stay in `saved`,
/// which must outlive them. Whatever the bytes are, the scene that comes back is safe to walk.
/// Error: the bytes are damaged, not aligned to kPartAlignment, or no saved levels; the sentence
/// goes on from a name.
Result<std::optional<BuiltScene>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t, uint64_t)>& limits_for,
               bool takes_any_limits = false);

/// Opens the levels that the store reads, for a soup of the store's meshes. Pages and lists stay on
/// the disk, and limits do not matter. Error: as of restore_levels(); they are of other meshes; or
/// of the kind OverBudget, where it names the smallest budget of the store that works.
Result<BuiltScene> open_stored_levels(LeafStore& store, const Soup& soup);

/// Does the same whatever the budget, for a plan: the store gives no page, but knows what it would
/// keep.
Result<BuiltScene> look_at_stored_levels(LeafStore& store, const Soup& soup);

} // namespace ovc
