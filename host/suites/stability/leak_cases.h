// SPDX-License-Identifier: Apache-2.0
// The cases of `overcast report --only leaks`: rays at edges and vertices that must hit, in large
// numbers.
#pragma once

#include "host/suites/stability/stability_cases.h"

namespace ovc {

/// Returns closed meshes at the origin and at all unpleasant places, without a number of rays; see
/// share_rays(). dragon: as for stability_cases(). It has holes, so rays are aimed at the
/// edges and vertices that its triangles surround without a gap (SoundTargets). Its cases share
/// state, so only one of them may run at a time.
std::vector<StabilityCase> leak_cases(const Scene* dragon);

/// Gives each case an equal share of `rays`, rounded up.
void share_rays(std::span<StabilityCase> cases, uint64_t rays);

} // namespace ovc
