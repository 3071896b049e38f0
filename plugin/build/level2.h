// SPDX-License-Identifier: Apache-2.0
// Cuts a soup into leaves whose pages fit the budget, and builds the pages.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "plugin/build/built_scene.h"

#include <cstdint>

namespace ovc {

/// Makes level 1 of leaves of at most leaf_triangles (> 0), cut by count (kdtree/partition.h), and
/// pages in which planes cut nothing. That takes the least memory, for a budget that has hardly
/// room for anything. in_one_frame: all leaves share a frame, whether it suits them or not.
void build_smallest_levels(BuiltScene& scene, Hittable hittable, uint32_t leaf_triangles,
                           bool in_one_frame, BuildProgress* progress = nullptr);

/// Makes level 1 and the pages, of leaves within scene.limits; a leaf whose page turns out too
/// large is cut further. share: the part of all building that this is, as `progress` goes from 0
/// to 1. Error: a page of a single triangle does not fit.
Result<Done> build_levels(BuiltScene& scene, const Hittable& hittable,
                          BuildProgress* progress = nullptr, double share = 1);

} // namespace ovc
