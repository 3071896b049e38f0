// SPDX-License-Identifier: Apache-2.0
// What a machine has of what a device needs: libraries, drivers' files, device files, and the
// container around the process.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace ovc {

struct DeviceFile {
    std::string path;
    std::string refusal; // why this user may not open it; empty: they may
};

struct Machine {
    std::string egl_refusal;              // why libEGL.so.1 does not load; empty: it does
    std::string gl_refusal;               // the same for libOpenGL.so.0 and libGL.so.1
    std::string egl_extensions;           // of EGL without a display
    std::vector<std::string> drivers;     // the files that tell libglvnd of EGL drivers
    std::vector<DeviceFile> device_files; // of GPUs: /dev/dri/renderD*, /dev/nvidia*
    bool has_nvidia_egl = false;          // libEGL_nvidia.so.0 loads
    bool in_container = false;
    std::optional<std::string> nvidia_capabilities; // NVIDIA_DRIVER_CAPABILITIES
    std::vector<std::string> overrides; // variables, NAME=value, that choose or hide drivers

    /// Returns whether there is a file of an NVIDIA GPU.
    bool has_nvidia_files() const;
};

/// Asks the machine that this process runs on.
Machine look_at_machine();

/// Returns what is missing and what to do about it, a sentence each. has_device: a device opens;
/// has_gpu: one that is no software renderer. Empty where nothing is missing.
std::vector<std::string> advice(const Machine& machine, bool has_device, bool has_gpu);

} // namespace ovc
