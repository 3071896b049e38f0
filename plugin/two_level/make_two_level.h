// SPDX-License-Identifier: Apache-2.0
// Two-level behind the ABI, for the libraries that have it.
#pragma once

#include "gpu/gl/egl_context.h"
#include "plugin/overcast.h"
#include "plugin/plan/two_level_options.h"

namespace ovc {

/// Throws a Failure where the config asks for something that two-level cannot do on the device; as
/// check_config().
void check_two_level(const ovc_scene_config& config, const DeviceInfo& device);

/// Returns the options that the config asks for. Its `saved` must outlive them.
TwoLevelOptions two_level_options(const ovc_scene_config& config);

/// As plan_structure().
Result<ovc_plan> plan_two_level(const Soup& soup, const DeviceInfo& device,
                                const ovc_scene_config& config, BuildProgress* progress,
                                LeafStore* store);

} // namespace ovc
