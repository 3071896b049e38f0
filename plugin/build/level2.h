// SPDX-License-Identifier: Apache-2.0
// Cuts a soup into leaves whose pages fit the budget, and builds the pages.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "plugin/build/built_scene.h"

#include <cstdint>

namespace ovc {

/// Makes level 1 of leaves of at most leaf_triangles, cut by count (kdtree/partition.h), and pages
/// in which planes cut nothing: what takes least where a budget has hardly room for anything.
/// in_one_frame: whether it suits all leaves or not.
void build_smallest_levels(BuiltScene& scene, Hittable hittable, uint32_t leaf_triangles,
                           bool in_one_frame, BuildProgress* progress = nullptr);

/// Makes level 1 and the pages, of leaves within scene.limits; one whose page turns out too large
/// is cut further. share: of all that is built while `progress` goes from 0 to 1, from 0 to 1.
/// Error: a page of a single triangle does not fit.
Result<Done> build_levels(BuiltScene& scene, const Hittable& hittable,
                          BuildProgress* progress = nullptr, double share = 1);

} // namespace ovc
