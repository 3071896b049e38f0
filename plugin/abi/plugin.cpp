// SPDX-License-Identifier: Apache-2.0
// The one exported function and the table it returns.
#include "plugin/abi/device.h"
#include "plugin/abi/scene.h"
#include "plugin/abi/stream_call.h"
#include "plugin/abi/ticket_call.h"
#include "plugin/abi/trace_call.h"
#include "plugin/overcast.h"

extern "C" const ovc_api* ovc_get_api(uint32_t abi_version) {
    static constexpr ovc_api api = {
        sizeof(ovc_api),
        OVC_ABI_VERSION,
        OVC_VERSION,
        ovc::last_error,
        ovc::list_devices,
        ovc::create_device,
        ovc::describe_device,
        ovc::destroy_device,
        ovc::create_scene,
        ovc::add_mesh,
        ovc::commit,
        ovc::intersect,
        ovc::occluded,
        ovc::statistics,
        ovc::destroy_scene,
        ovc::stream,
        ovc::push,
        ovc::plan,
        ovc::active,
        ovc::save,
        ovc::add_instance,
        ovc::purge,
        ovc::intersect1,
        ovc::occluded1,
        ovc::submit_intersect,
        ovc::submit_occluded,
        ovc::wait,
        ovc::poll,
        ovc::cancel,
        ovc::release,
        ovc::all_hits,
        ovc::update_mesh,
        ovc::update_instance,
        ovc::remove_mesh,
        ovc::save_streamed,
        ovc::prepare_process,
        ovc::plan_streamed,
    };
    return abi_version == OVC_ABI_VERSION ? &api : nullptr;
}
