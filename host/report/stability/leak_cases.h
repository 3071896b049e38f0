// SPDX-License-Identifier: Apache-2.0
// The table of `overcast report --only leaks`: rays at edges and vertices that must hit, in large
// numbers.
#pragma once

#include "host/report/stability/stability_cases.h"

namespace ovc {

/// Closed meshes at the origin and at all unpleasant places, without a number of rays. data: as for
/// stability_cases; the dragon has holes, so rays are aimed at what its triangles surround without
/// a gap (SoundTargets). Error: there is no dragon in it. The dragon's cases run one at a time.
Result<std::vector<StabilityCase>> leak_cases(const std::string& data);

/// Gives each case an equal share of `rays`, rounded up.
void share_rays(std::span<StabilityCase> cases, uint64_t rays);

} // namespace ovc
