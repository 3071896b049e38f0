// SPDX-License-Identifier: Apache-2.0
// Makes the backend that is asked for, or for Auto the first one that this machine has.
#include "host/backend/backend.h"
#include "host/backend/device_opening.h"
#include "host/backend/plugin_loader.h"

#include <fmt/format.h>

namespace ovc {

Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log) {
    DeviceOpening opening(options);
    return make_backend(soup, options, log, opening);
}

Result<std::unique_ptr<Backend>> make_backend(const Soup& soup, const BackendOptions& options,
                                              const LogSink& log, DeviceOpening& opening) {
    if (options.kind == BackendKind::CpuKdTree)
        return make_cpu_backend(soup, log);
    if (options.kind == BackendKind::Embree)
        return make_embree_backend(soup, EmbreeMode::Robust, log);
    ovc_result code = OVC_OK;
    Result<PluginDevice> device = opening.finish(log, code);
    if (device)
        return make_plugin_backend(std::move(*device), soup, options, log);
    if (code == OVC_OK)
        return Error{device.error().message + " (--backend cpu-kdtree works without it)"};
    // A user who named a device or a backend meant it, and must mend a wrong setting. Where there
    // just is no device, the CPU makes the picture, slower, and a warning tells why.
    if (options.kind != BackendKind::Auto || !options.device.empty() || code != OVC_ERROR_NO_DEVICE)
        return Error{device.error().message + " (--backend cpu-kdtree works without EGL)"};
    say(log, LogLevel::Warning,
        fmt::format("tracing on the CPU KD-tree instead of a GPU: {}", device.error().message));
    return make_cpu_backend(soup, log);
}

Result<ovc_plan> make_plan(const Soup& soup, const BackendOptions& options, const LogSink& log) {
    if (options.kind == BackendKind::CpuKdTree || options.kind == BackendKind::Embree)
        return Error{"a backend on the CPU has no plan: it uses no GPU memory"};
    const Result<const ovc_api*> api =
        load_plugin(structure_of(options.kind) == OVC_STRUCTURE_TWO_LEVEL ? kProduct : kThesis);
    if (!api)
        return api.error();
    const Result<PluginDevice> device = PluginDevice::open(*api, options.device, log);
    if (!device)
        return device.error();
    return make_plugin_plan(*device, soup, options, log);
}

} // namespace ovc
