// SPDX-License-Identifier: Apache-2.0
// DeviceOpening: the plugin is loaded and its device opened beside other work, such as reading the
// scene: loading the driver's libraries and making a context take 0.05 s on llvmpipe, of one core.
#pragma once

#include "host/backend/backend.h"
#include "host/backend/plugin_loader.h"

#include <future>
#include <memory>

namespace ovc {

class DeviceOpening {
public:
    /// Begins to open the device of these options, on a thread of its own; a backend on the CPU has
    /// none. Whoever lets go of it unfinished waits until the device is open, and closed again.
    explicit DeviceOpening(const BackendOptions& options);

    /// Waits for the device; once. What was said of it meanwhile goes to the log now, and all that
    /// is said later as it comes. code: what the plugin said; OVC_OK where it was not found.
    Result<PluginDevice> finish(const LogSink& log, ovc_result& code);

private:
    struct HeldLog;
    struct Opened {
        Result<PluginDevice> device;
        ovc_result code;
    };

    std::shared_ptr<HeldLog> held_;
    std::future<Opened> opened_;
};

} // namespace ovc
