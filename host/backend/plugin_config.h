// SPDX-License-Identifier: Apache-2.0
// config_of() puts the options of a backend into the words of the ABI.
#pragma once

#include "host/backend/backend.h"
#include "plugin/overcast.h"

namespace ovc {

/// Error: a share of the device's memory that is less than a byte. A warning in the log tells of a
/// budget beyond the device's memory.
Result<ovc_scene_config> config_of(const BackendOptions& options, const ovc_device_info& info,
                                   const LogSink& log);

} // namespace ovc
