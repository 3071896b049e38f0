// SPDX-License-Identifier: Apache-2.0
// The table's functions on devices.
#pragma once

#include "plugin/overcast.h"

#include <string>

namespace ovc {

const char* last_error(ovc_device device) noexcept;
ovc_result list_devices(ovc_device_info* infos, uint32_t capacity, uint32_t* count);
ovc_result create_device(const ovc_device_config* config, ovc_device* device);
ovc_result prepare_process(ovc_kernel kernel);
ovc_result describe_device(ovc_device device, ovc_device_info* info);
void destroy_device(ovc_device device);

/// Returns whether the handle is that of a device that lives and belongs to this process, not to
/// the one that this was forked from. If not, it records a message for last_error(NULL) that begins
/// with the name of the call.
bool is_device(ovc_device device, const char* call);
/// Records a message for last_error(NULL) and returns the code.
ovc_result fail_without_device(ovc_result code, const std::string& message);

} // namespace ovc
