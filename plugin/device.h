// SPDX-License-Identifier: Apache-2.0
// The table's functions on devices.
#pragma once

#include "plugin/overcast.h"

namespace ovc {

const char* last_error(ovc_device device);
ovc_result list_devices(ovc_device_info* infos, uint32_t capacity, uint32_t* count);
ovc_result create_device(const ovc_device_config* config, ovc_device* device);
ovc_result describe_device(ovc_device device, ovc_device_info* info);
void destroy_device(ovc_device device);

/// Runs body for a call on `device`; a null or foreign handle is reported on this thread instead.
bool is_device(ovc_device device);
/// Records a message for last_error(NULL) and returns the code.
ovc_result fail_without_device(ovc_result code, const char* message);

} // namespace ovc
