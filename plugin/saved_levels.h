// SPDX-License-Identifier: Apache-2.0
// Levels as bytes that outlive the process: level 1 and the pages, and what they were made of.
#pragma once

#include "core/archive.h"
#include "core/twins.h"
#include "gpu/page.h"
#include "plugin/level2.h"

#include <functional>
#include <optional>

namespace ovc {

/// What a commit makes of a soup before anything goes to a GPU.
struct BuiltLevels {
    Dropped dropped;
    Twins twins;
    uint64_t triangles = 0; // in leaves, each counted once
    LeafLimits limits{};    // that the leaves keep to
    Level1 level1;
    std::vector<Page> pages; // pages[i] belongs to level1.leaves[i]
};

/// The same, where it lies.
struct BuiltLevelsView {
    const Dropped& dropped;
    const Twins& twins;
    uint64_t triangles;
    const LeafLimits& limits;
    const Level1& level1;
    std::span<const Page> pages;
};

/// Passes them on to the sink, front to back. False where it wanted no more.
bool save_levels(const Soup& soup, const BuiltLevelsView& levels, const ByteSink& sink);

/// What save_levels() wrote of this soup. Pages stay in `saved`, which is aligned to
/// kPartAlignment and outlives them. Nothing: they are of another soup, or a build would now make
/// others of it. limits_for: the limits for so many triangles. Error: they are damaged, or not such
/// bytes; the sentence goes on from a name. Whatever the bytes are, what comes back is safe to
/// walk.
Result<std::optional<BuiltLevels>>
restore_levels(Bytes saved, const Soup& soup,
               const std::function<LeafLimits(uint64_t)>& limits_for);

} // namespace ovc
