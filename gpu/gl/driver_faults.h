// SPDX-License-Identifier: Apache-2.0
// Drivers that end the process when our kernels are compiled: they are passed over, with a
// sentence.
#pragma once

#include <string_view>

namespace ovc {

struct DriverFault {
    std::string_view renderer; // how GL_RENDERER begins, as the next for GL_VERSION has in it
    std::string_view version;
    const char* symptom;
};

inline constexpr DriverFault kDriverFaults[] = {
    {"zink", "Mesa 22.3",
     "it crashes when kernels are compiled (seen over lavapipe); another driver is chosen by "
     "unsetting MESA_LOADER_DRIVER_OVERRIDE"},
};

/// The symptom of the fault that this driver is known for; null where none is known.
constexpr const char* known_fault(std::string_view renderer, std::string_view version) {
    for (const DriverFault& fault : kDriverFaults)
        if (renderer.starts_with(fault.renderer) &&
            version.find(fault.version) != std::string_view::npos)
            return fault.symptom;
    return nullptr;
}

} // namespace ovc
