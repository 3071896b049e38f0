// SPDX-License-Identifier: Apache-2.0
// The one exported function and the table it returns.
#include "plugin/abi/device.h"
#include "plugin/abi/handles.h"
#include "plugin/abi/scene.h"
#include "plugin/abi/stream_call.h"
#include "plugin/abi/ticket_call.h"
#include "plugin/abi/trace_call.h"
#include "plugin/overcast.h"

namespace ovc {

static constexpr ovc_api kApi = {
    sizeof(ovc_api),
    OVC_ABI_VERSION,
    OVC_VERSION,
    last_error,
    no_throw<list_devices>,
    no_throw<create_device>,
    no_throw<describe_device>,
    no_throw<destroy_device>,
    no_throw<create_scene>,
    no_throw<add_mesh>,
    no_throw<commit>,
    no_throw<intersect>,
    no_throw<occluded>,
    no_throw<statistics>,
    no_throw<destroy_scene>,
    no_throw<stream>,
    no_throw<push>,
    no_throw<plan>,
    no_throw<active>,
    no_throw<save>,
    no_throw<add_instance>,
    no_throw<purge>,
    no_throw<intersect1>,
    no_throw<occluded1>,
    no_throw<submit_intersect>,
    no_throw<submit_occluded>,
    no_throw<wait>,
    no_throw<poll>,
    no_throw<cancel>,
    no_throw<release>,
    no_throw<all_hits>,
    no_throw<update_mesh>,
    no_throw<update_instance>,
    no_throw<remove_mesh>,
    no_throw<save_streamed>,
    no_throw<prepare_process>,
    no_throw<plan_streamed>,
};

} // namespace ovc

extern "C" const ovc_api* ovc_get_api(uint32_t abi_version) {
    return abi_version == OVC_ABI_VERSION ? &ovc::kApi : nullptr;
}
