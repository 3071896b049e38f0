// SPDX-License-Identifier: Apache-2.0
// The host's side of the plugin: it finds the library and owns its handles, and adds nothing else
// to the C calls.
#pragma once

#include "core/result.h"
#include "core/system/log.h"
#include "plugin/overcast.h"

#include <memory>
#include <string>
#include <vector>

namespace ovc {

/// The libraries that have the ABI: that of two-level, and that of the systems of the thesis.
inline constexpr const char* kProduct = "libovercast.so.1"; // by its soname
static_assert(OVC_ABI_VERSION == 1);
inline constexpr const char* kThesis = "libovercast-thesis.so";

/// Returns the path of a library: beside this program, else where it is installed as seen from
/// there, else its name alone for the system's loader. Where the environment variable OVC_PLUGIN is
/// set, it is the path of the product.
std::string find_plugin(const std::string& library = kProduct);

/// Loads the library that find_plugin() finds; among several ranks, kRankedProduct in the place of
/// the product. It stays loaded until the program ends.
Result<const ovc_api*> load_plugin(const std::string& library = kProduct);

/// Lets a library prepare the process for scenes that ask for this kernel; see overcast.h. A
/// library that cannot be loaded is told of where a device is opened.
void prepare_process(ovc_kernel kernel, const std::string& library = kProduct);

struct DestroyDevice {
    const ovc_api* api = nullptr;
    void operator()(ovc_device device) const { api->destroy_device(device); }
};

struct DestroyScene {
    const ovc_api* api = nullptr;
    void operator()(ovc_scene scene) const { api->destroy_scene(scene); }
};

using PluginScene = std::unique_ptr<ovc_scene_t, DestroyScene>;

/// An open device. Its Errors are the sentences that the library gives as its last error.
class PluginDevice {
public:
    /// Opens a device. name: a number as listed or a part of the renderer's name; empty: the plugin
    /// chooses. log: may be called from the device's thread as long as the device lives. code:
    /// optional, receives the library's result.
    static Result<PluginDevice> open(const ovc_api* api, const std::string& name, LogSink log,
                                     ovc_result* code = nullptr);

    const ovc_api* api() const { return api_; }
    Result<ovc_device_info> describe() const;
    Result<PluginScene> create_scene(const ovc_scene_config& config) const;
    /// Builds and saves a scene that streams; see overcast.h.
    Result<Done> save_streamed(const ovc_scene_config& config,
                               const ovc_streamed_scene& scene) const;
    /// Plans that.
    Result<ovc_plan> plan_streamed(const ovc_scene_config& config,
                                   const ovc_streamed_scene& scene) const;

    /// Returns Done when `result` is OVC_OK, else the library's sentence. Call it right after the
    /// call that failed: the next one may replace the sentence.
    Result<Done> checked(ovc_result result) const;

private:
    PluginDevice(const ovc_api* api, std::unique_ptr<LogSink> log)
        : api_(api), log_(std::move(log)) {}

    const ovc_api* api_;
    std::unique_ptr<LogSink> log_; // the library holds its address
    std::unique_ptr<ovc_device_t, DestroyDevice> device_;
};

/// Returns all devices that the plugin can run on.
Result<std::vector<ovc_device_info>> list_devices(const ovc_api* api);

} // namespace ovc
