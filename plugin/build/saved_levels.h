// SPDX-License-Identifier: Apache-2.0
// A scene as bytes that outlive the process: level 1 and the pages, and what they were made of.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"
#include "plugin/build/built_scene.h"

#include <functional>
#include <optional>

namespace ovc {

/// Passes the scene on to the sink, front to back. False where the sink wanted no more.
bool save_levels(const BuiltScene& scene, const ByteSink& sink);

/// The scene that save_levels() wrote of this soup. Pages stay in `saved`, which is aligned to
/// kPartAlignment and outlives them. Nothing: what was saved is of another soup, or a build would
/// now make another scene. limits_for: as limits_of(triangles, unique). Error: the bytes are
/// damaged, or are not such bytes; the sentence goes on from a name. Whatever the bytes are, the
/// scene that comes back is safe to walk.
Result<std::optional<BuiltScene>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t, uint64_t)>& limits_for);

} // namespace ovc
