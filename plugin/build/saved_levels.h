// SPDX-License-Identifier: Apache-2.0
// Saves a scene as bytes that outlive the process, and restores it: level 1 and the pages, and a
// key of what they were made of.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"
#include "plugin/build/built_scene.h"

#include <functional>
#include <optional>

namespace ovc {

/// Passes the scene on to the sink, front to back. Returns false where the sink wanted no more.
bool save_levels(const BuiltScene& scene, const ByteSink& sink);

/// Returns the scene that save_levels() wrote of this soup; nothing where the bytes are of another
/// soup, or where a build would now make another scene. limits_for(triangles, unique): as
/// limits_of(). The pages stay in `saved`, which must outlive them. Whatever the bytes are, the
/// scene that comes back is safe to walk. Error: the bytes are damaged, not aligned to
/// kPartAlignment, or no saved levels; the sentence goes on from a name.
Result<std::optional<BuiltScene>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t, uint64_t)>& limits_for);

} // namespace ovc
