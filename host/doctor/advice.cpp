// SPDX-License-Identifier: Apache-2.0
// Advice where a machine lacks something, in the order in which things are needed.
#include "host/doctor/machine.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

/// Says what an NVIDIA GPU lacks whose device files are there.
static std::string nvidia_advice(const Machine& machine) {
    const auto& capabilities = machine.nvidia_capabilities;
    const bool graphics = !capabilities || capabilities->find("graphics") != std::string::npos ||
                          capabilities->find("all") != std::string::npos;
    if (!graphics)
        return fmt::format("The container was started with NVIDIA_DRIVER_CAPABILITIES={}, which "
                           "hands in no OpenGL: start it with graphics added, or all.",
                           *capabilities);
    if (machine.in_container)
        return "The container has an NVIDIA GPU but not its EGL driver, libEGL_nvidia.so.0: start "
               "it with NVIDIA_DRIVER_CAPABILITIES=all.";
    return "There is an NVIDIA GPU but not its EGL driver: install libegl-nvidia0, or the driver "
           "of "
           "NVIDIA's site with its OpenGL files.";
}

std::vector<std::string> advice(const Machine& machine, bool has_device, bool has_gpu) {
    std::vector<std::string> said;
    if (!machine.egl_refusal.empty())
        said.push_back("EGL is missing: install libegl1.");
    if (!machine.gl_refusal.empty())
        said.push_back("OpenGL is missing: install libopengl0 or libgl1.");
    if (machine.egl_refusal.empty() && machine.drivers.empty() && !has_device)
        said.push_back("EGL knows no driver: install your GPU's, or libegl-mesa0 and "
                       "libgl1-mesa-dri for the software renderer.");
    for (const DeviceFile& file : machine.device_files)
        if (!file.refusal.empty() && !has_gpu)
            said.push_back(fmt::format(
                "{} cannot be opened ({}): add the user to the group of that file, which is render "
                "on Debian{}.",
                file.path, file.refusal,
                machine.in_container ? ", or have the container hand it in with its rights" : ""));
    if (machine.has_nvidia_files() && !machine.has_nvidia_egl && !has_gpu)
        said.push_back(nvidia_advice(machine));
    if (machine.device_files.empty() && machine.in_container && !has_gpu)
        said.push_back("The container has no device file of a GPU: start it with --device /dev/dri "
                       "for AMD and Intel, or with NVIDIA's runtime and --gpus all.");
    if (!has_device && !machine.overrides.empty())
        said.push_back(fmt::format("These variables choose or hide drivers; try without them: {}.",
                                   fmt::join(machine.overrides, ", ")));
    if (!has_device && said.empty())
        said.push_back("The drivers that EGL knows do not start: install libgl1-mesa-dri for the "
                       "software renderer, and see docs/guide/gpu.md.");
    return said;
}

} // namespace ovc
