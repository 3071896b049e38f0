// SPDX-License-Identifier: Apache-2.0
// The rows of devices.
#include "tests/misuse/entries.h"

namespace ovc::test {
namespace {

Misuses nothing_wrong(Subject&) {
    return {};
}

ovc_result use_last_error(Subject& s) {
    return api().last_error(s.device) && api().last_error(nullptr) ? OVC_OK : OVC_ERROR_INTERNAL;
}

ovc_result use_list_devices(Subject&) {
    uint32_t count = 0;
    ovc_device_info info = sized<ovc_device_info>();
    const ovc_result result = api().list_devices(&info, 1, &count);
    return result == OVC_OK && (count == 0 || !info.renderer[0]) ? OVC_ERROR_INTERNAL : result;
}
Misuses misuse_list_devices(Subject& s) {
    Wrong wrong(s);
    uint32_t count;
    ovc_device_info unsized{};
    wrong.without_device("count NULL", api().list_devices(nullptr, 0, nullptr));
    wrong.without_device("infos NULL", api().list_devices(nullptr, 1, &count));
    wrong.without_device("struct_size 0", api().list_devices(&unsized, 1, &count));
    return wrong.found();
}

ovc_result use_create_device(Subject&) {
    ovc_device device = nullptr;
    const ovc_result result = api().create_device(nullptr, &device);
    api().destroy_device(device);
    return result;
}
Misuses misuse_create_device(Subject& s) {
    Wrong wrong(s);
    ovc_device device;
    ovc_device_config unsized{};
    auto reserved = sized<ovc_device_config>();
    reserved.reserved = 1;
    wrong.without_device("device NULL", api().create_device(nullptr, nullptr));
    wrong.without_device("struct_size 0", api().create_device(&unsized, &device));
    wrong.without_device("reserved 1", api().create_device(&reserved, &device));
    return wrong.found();
}

/// Devices are listed before, so that it is too late.
ovc_result use_prepare_process(Subject& s) {
    if (const ovc_result listed = use_list_devices(s); listed != OVC_OK)
        return listed;
    return api().prepare_process(OVC_KERNEL_AUTO) == OVC_ERROR_INVALID_STATE ? OVC_OK
                                                                             : OVC_ERROR_INTERNAL;
}
Misuses misuse_prepare_process(Subject& s) {
    Wrong wrong(s);
    wrong.without_device("kernel 3", api().prepare_process(ovc_kernel(3)));
    return wrong.found();
}

ovc_result use_describe_device(Subject& s) {
    ovc_device_info info = sized<ovc_device_info>();
    const ovc_result result = api().describe_device(s.device, &info);
    return info.default_budget_bytes ? result : OVC_ERROR_INTERNAL;
}
Misuses misuse_describe_device(Subject& s) {
    Wrong wrong(s);
    ovc_device_info unsized{};
    wrong.without_device("device NULL", api().describe_device(nullptr, &unsized));
    wrong.argument("info NULL", api().describe_device(s.device, nullptr));
    wrong.argument("struct_size 0", api().describe_device(s.device, &unsized));
    ovc_device_info odd{sizeof(ovc_device_info) - 1};
    wrong.argument("struct_size within a field", api().describe_device(s.device, &odd));
    return wrong.found();
}

/// Calls destroy_device on a device with scenes, which is refused. The device must still work.
ovc_result use_destroy_device(Subject& s) {
    api().destroy_device(nullptr);
    api().destroy_device(s.device);
    return use_describe_device(s);
}

constexpr Entry kDeviceEntries[] = {
    OVC_ENTRY(last_error, use_last_error, nothing_wrong),
    OVC_ENTRY(list_devices, use_list_devices, misuse_list_devices),
    OVC_ENTRY(create_device, use_create_device, misuse_create_device),
    OVC_ENTRY(prepare_process, use_prepare_process, misuse_prepare_process),
    OVC_ENTRY(describe_device, use_describe_device, misuse_describe_device),
    OVC_ENTRY(destroy_device, use_destroy_device, nothing_wrong),
};

} // namespace

std::span<const Entry> device_entries() {
    return kDeviceEntries;
}

} // namespace ovc::test
