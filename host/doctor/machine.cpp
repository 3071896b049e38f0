// SPDX-License-Identifier: Apache-2.0
#include "host/doctor/machine.h"

#include <dlfcn.h>
#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <filesystem>

namespace ovc {

namespace fs = std::filesystem;

bool Machine::has_nvidia_files() const {
    return std::ranges::any_of(
        device_files, [](const DeviceFile& file) { return file.path.starts_with("/dev/nvidia"); });
}

/// Returns why a library does not load; nothing where it does. It stays loaded.
static std::string refusal_of(const char* library) {
    if (dlopen(library, RTLD_LAZY | RTLD_LOCAL))
        return {};
    const char* const reason = dlerror();
    return reason ? reason : "no reason given";
}

/// Asks EGL without its headers, because it may be missing here.
static std::string client_extensions() {
    void* const egl = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
    if (!egl)
        return {};
    using QueryString = const char* (*)(void* display, int name);
    const auto query = reinterpret_cast<QueryString>(dlsym(egl, "eglQueryString"));
    constexpr int kExtensions = 0x3055;
    const char* const found = query ? query(nullptr, kExtensions) : nullptr;
    return found ? found : "";
}

/// Returns the paths in a folder whose names begin so, sorted.
static std::vector<std::string> files_in(const fs::path& folder, const std::string& beginning) {
    std::vector<std::string> paths;
    std::error_code failed;
    for (const auto& entry : fs::directory_iterator(folder, failed))
        if (entry.path().filename().string().starts_with(beginning))
            paths.push_back(entry.path().string());
    std::ranges::sort(paths);
    return paths;
}

static std::vector<DeviceFile> device_files() {
    std::vector<std::string> paths = files_in("/dev/dri", "renderD");
    std::error_code failed;
    for (std::string& path : files_in("/dev", "nvidia"))
        if (!fs::is_directory(path, failed))
            paths.push_back(std::move(path));
    std::vector<DeviceFile> files;
    for (const std::string& path : paths) {
        const int file = open(path.c_str(), O_RDWR | O_CLOEXEC);
        files.push_back({path, file < 0 ? std::strerror(errno) : ""});
        if (file >= 0)
            close(file);
    }
    return files;
}

Machine look_at_machine() {
    Machine machine;
    machine.egl_refusal = refusal_of("libEGL.so.1");
    machine.gl_refusal = refusal_of("libOpenGL.so.0");
    if (!machine.gl_refusal.empty())
        machine.gl_refusal = refusal_of("libGL.so.1");
    machine.egl_extensions = client_extensions();
    for (const char* folder : {"/etc/glvnd/egl_vendor.d", "/usr/share/glvnd/egl_vendor.d"})
        for (std::string& file : files_in(folder, ""))
            machine.drivers.push_back(std::move(file));
    machine.device_files = device_files();
    machine.has_nvidia_egl = refusal_of("libEGL_nvidia.so.0").empty();
    std::error_code failed;
    machine.in_container = fs::exists("/.dockerenv", failed) ||
                           fs::exists("/run/.containerenv", failed) ||
                           std::getenv("KUBERNETES_SERVICE_HOST");
    if (const char* value = std::getenv("NVIDIA_DRIVER_CAPABILITIES"))
        machine.nvidia_capabilities = value;
    for (const char* name :
         {"MESA_LOADER_DRIVER_OVERRIDE", "GALLIUM_DRIVER", "LIBGL_ALWAYS_SOFTWARE",
          "LIBGL_DRIVERS_PATH", "EGL_PLATFORM", "__EGL_VENDOR_LIBRARY_FILENAMES",
          "__EGL_VENDOR_LIBRARY_DIRS", "CUDA_VISIBLE_DEVICES", "NVIDIA_VISIBLE_DEVICES",
          "OVERCAST_NO_WORKAROUNDS"})
        if (const char* value = std::getenv(name))
            machine.overrides.push_back(std::string(name) + "=" + value);
    return machine;
}

} // namespace ovc
