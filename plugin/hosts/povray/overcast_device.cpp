// SPDX-License-Identifier: AGPL-3.0-or-later
#include "plugin/hosts/povray/overcast_device.h"

#include <algorithm>
#include <cstdio>
#include <optional>

#include <dlfcn.h>

/// From the start of a line: POV-Ray counts words there while it parses.
static void say(void*, ovc_log_level level, const char* message) {
    if (level != OVC_LOG_INFO)
        std::fprintf(stderr, "\rpovray-overcast: %s\n", message);
}

/// The library stays loaded: its code may run until the process ends.
static const ovc_api* load(const std::string& path) {
    void* library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
    if (!library)
        throw OvercastFailure(dlerror());
    ovc_get_api_function get_api;
    *reinterpret_cast<void**>(&get_api) = dlsym(library, "ovc_get_api");
    const ovc_api* api = get_api ? get_api(OVC_ABI_VERSION) : nullptr;
    if (!api || api->struct_size < sizeof(ovc_api))
        throw OvercastFailure(path + " is no libovercast.so, or one older than this program");
    return api;
}

std::shared_ptr<OvercastDevice> OvercastDevice::open(const OvercastSettings& settings) {
    static std::mutex mutex;
    static std::weak_ptr<OvercastDevice> opened;
    static std::optional<OvercastFailure> failed;
    const std::lock_guard lock(mutex);
    if (failed)
        throw *failed;
    std::shared_ptr<OvercastDevice> device = opened.lock();
    if (device)
        return device;
    try {
        device = std::make_shared<OvercastDevice>(settings);
    } catch (const OvercastFailure& failure) {
        failed = failure;
        throw;
    }
    opened = device;
    return device;
}

OvercastDevice::OvercastDevice(const OvercastSettings& settings) : api_(load(settings.library)) {
    ovc_device_config config{};
    config.struct_size = sizeof config;
    config.name = settings.device.empty() ? nullptr : settings.device.c_str();
    config.log = say;
    check(api_->create_device(&config, &device_));
    info_.struct_size = sizeof info_;
    api_->describe_device(device_, &info_);
}

OvercastDevice::~OvercastDevice() {
    api_->destroy_device(device_);
    std::fprintf(
        stderr, "povray-overcast: meshes: %llu, triangles: %llu, rays: %llu, renderer: %s\n",
        static_cast<unsigned long long>(meshes_), static_cast<unsigned long long>(triangles_),
        static_cast<unsigned long long>(rays_), info_.renderer);
}

uint64_t OvercastDevice::budget_for(long triangles) const {
    constexpr uint64_t kSmallest = 1 << 20;
    constexpr uint64_t kTriangleBytes = 256; // pages take up to 115, an eighth of a budget is rays'
    return std::min<uint64_t>(info_.default_budget_bytes,
                              kSmallest + kTriangleBytes * uint64_t(triangles));
}

void OvercastDevice::count(long triangles, uint64_t rays) {
    const std::lock_guard lock(counting_);
    ++meshes_;
    triangles_ += uint64_t(triangles);
    rays_ += rays;
}
