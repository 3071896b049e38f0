// SPDX-License-Identifier: Apache-2.0
// on_device(): the frame of every function of the table that works on a device.
#pragma once

#include "core/text/format_text.h"
#include "plugin/abi/device.h"
#include "plugin/abi/handles.h"

namespace ovc {

/// Runs body() while the device cannot be destroyed; guard() turns what it throws into a code.
template <class Body>
ovc_result on_device(ovc_device device, const char* call, Body&& body) {
    if (!is_device(device, call))
        return OVC_ERROR_INVALID_ARGUMENT;
    const CallsInside::Call inside(device->calls);
    if (device->magic != kDeviceMagic)
        return fail_without_device(OVC_ERROR_INVALID_STATE,
                                   format_text("{}: the device is being destroyed", call));
    return guard(device->messages, [&] {
        const LoopThreads::Scope threads(device->loops);
        body();
    });
}

} // namespace ovc
