// SPDX-License-Identifier: Apache-2.0
// Loads the plugin by dlopen, and wraps its handles.
#include "host/backend/plugin_loader.h"

#include "host/ranks/ranks.h"

#include <dlfcn.h>
#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cstdlib>
#include <filesystem>
#include <system_error>

namespace ovc {

namespace fs = std::filesystem;

static std::string sentence_of(const ovc_api* api, ovc_device device, ovc_result result) {
    const std::string sentence = api->last_error(device);
    return sentence.empty() ? fmt::format("the plugin failed with code {}", int(result)) : sentence;
}

static Result<const ovc_api*> load_from(const std::string& path) {
    // The library is never unloaded: GL drivers leave handlers for the end of threads behind, which
    // must still find their code.
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (!library)
        return Error{fmt::format("cannot load the plugin: {}", dlerror())};
    const auto get_api = reinterpret_cast<ovc_get_api_function>(dlsym(library, "ovc_get_api"));
    if (!get_api)
        return Error{fmt::format("'{}' is not an Overcast plugin: it has no ovc_get_api", path)};
    const ovc_api* api = get_api(OVC_ABI_VERSION);
    if (!api)
        return Error{fmt::format("the plugin '{}' does not speak version {} of the interface", path,
                                 OVC_ABI_VERSION)};
    if (api->struct_size < sizeof(ovc_api))
        return Error{
            fmt::format("the plugin '{}' is older than this program: its table has {} bytes, "
                        "{} are needed",
                        path, api->struct_size, sizeof(ovc_api))};
    return api;
}

std::string find_plugin(const std::string& library) {
    if (const char* named = std::getenv("OVC_PLUGIN"); named && *named && library == kProduct)
        return named;
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    const fs::path installed = (folder / OVC_LIBRARY_FROM_COMMAND).lexically_normal();
    for (const fs::path& path :
         {folder / library, installed / library, installed / "overcast" / library})
        if (!error && fs::exists(path))
            return path;
    return library;
}

Result<const ovc_api*> load_plugin(const std::string& library) {
    const bool is_ranked = library == kProduct && Ranks::of_run();
    return load_from(find_plugin(is_ranked ? kRankedProduct : library));
}

void prepare_process(ovc_kernel kernel, const std::string& library) {
    if (const Result<const ovc_api*> api = load_plugin(library))
        (*api)->prepare_process(kernel); // where it comes too late, the log tells what that costs
}

static void forward_log(void* user, ovc_log_level level, const char* message) {
    say(*static_cast<const LogSink*>(user), LogLevel(level), message);
}

Result<PluginDevice> PluginDevice::open(const ovc_api* api, const std::string& name, LogSink log,
                                        ovc_result* code) {
    assert(api);
    PluginDevice opened(api, std::make_unique<LogSink>(std::move(log)));
    ovc_device_config config{};
    config.struct_size = sizeof(config);
    config.name = name.empty() ? nullptr : name.c_str();
    config.log = forward_log;
    config.log_user = opened.log_.get();
    ovc_device device = nullptr;
    const ovc_result result = api->create_device(&config, &device);
    if (code)
        *code = result;
    if (result != OVC_OK)
        return Error{sentence_of(api, nullptr, result)};
    opened.device_ = {device, DestroyDevice{api}};
    return opened;
}

Result<Done> PluginDevice::checked(ovc_result result) const {
    if (result == OVC_OK)
        return Done{};
    const ErrorKind kind = result == OVC_ERROR_CANCELLED       ? ErrorKind::Cancelled
                           : result == OVC_ERROR_UNREADABLE    ? ErrorKind::Unreadable
                           : result == OVC_ERROR_OUT_OF_BUDGET ? ErrorKind::OverBudget
                                                               : ErrorKind::Other;
    return Error{sentence_of(api_, device_.get(), result), kind};
}

Result<ovc_device_info> PluginDevice::describe() const {
    ovc_device_info info{};
    info.struct_size = sizeof(info);
    if (const Result<Done> done = checked(api_->describe_device(device_.get(), &info)); !done)
        return done.error();
    return info;
}

Result<PluginScene> PluginDevice::create_scene(const ovc_scene_config& config) const {
    ovc_scene scene = nullptr;
    if (const Result<Done> done = checked(api_->create_scene(device_.get(), &config, &scene));
        !done)
        return done.error();
    return PluginScene(scene, DestroyScene{api_});
}

Result<Done> PluginDevice::save_streamed(const ovc_scene_config& config,
                                         const ovc_streamed_scene& scene) const {
    return checked(api_->save_streamed(device_.get(), &config, &scene));
}

Result<ovc_plan> PluginDevice::plan_streamed(const ovc_scene_config& config,
                                             const ovc_streamed_scene& scene) const {
    ovc_plan plan{};
    plan.struct_size = sizeof(plan);
    if (const Result<Done> done =
            checked(api_->plan_streamed(device_.get(), &config, &scene, &plan));
        !done)
        return done.error();
    return plan;
}

Result<std::vector<ovc_device_info>> list_devices(const ovc_api* api) {
    ovc_device_info empty{};
    empty.struct_size = sizeof(empty);
    uint32_t count = 0;
    ovc_result result = api->list_devices(nullptr, 0, &count);
    std::vector<ovc_device_info> infos(count, empty);
    if (result == OVC_OK && count > 0)
        result = api->list_devices(infos.data(), count, &count);
    if (result != OVC_OK)
        return Error{sentence_of(api, nullptr, result)};
    infos.resize(std::min<size_t>(count, infos.size()));
    return infos;
}

} // namespace ovc
