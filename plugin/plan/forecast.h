// SPDX-License-Identifier: Apache-2.0
// forecast(): tells by a sample what two-level would make of a soup, before anything is built.
#pragma once

#include "core/build_progress.h"
#include "core/result.h"
#include "core/soup.h"
#include "plugin/overcast.h"
#include "plugin/plan/two_level_options.h"

namespace ovc {

/// Returns the plan of a soup, with `seconds` left to the caller. Looks at every triangle twice and
/// builds level 1 and pages over a sample; a soup of a few thousand triangles is built and thrown
/// away. Error: as of plan_memory(), too many triangles included. Throws Cancelled when `progress`
/// is told to stop.
Result<ovc_plan> forecast(const Soup& soup, const TwoLevelOptions& options,
                          const DeviceInfo& device, BuildProgress* progress = nullptr);

} // namespace ovc
