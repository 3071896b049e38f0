// SPDX-License-Identifier: Apache-2.0
// DeviceOpening loads the plugin and opens its device beside other work, such as reading the scene.
// Loading the driver's libraries and making a context take 0.05 s of one core on llvmpipe.
#pragma once

#include "host/backend/backend.h"
#include "host/backend/plugin_loader.h"

#include <future>
#include <memory>

namespace ovc {

/// Lets the library prepare the process for the only backend that it will have.
void prepare_process(const BackendOptions& options);

class DeviceOpening {
public:
    /// Begins to open the device of these options on a thread of its own, unless the backend needs
    /// none. A destructor without finish() waits until the device is open, and closed again.
    explicit DeviceOpening(const BackendOptions& options);

    /// Waits for the device and returns it. Call it at most once, and not for a backend on the CPU.
    /// Messages held back so far go to the log now, later ones as they come. code: receives the
    /// plugin's result, or OVC_OK where the plugin was not found.
    Result<PluginDevice> finish(const LogSink& log, ovc_result& code);

private:
    struct HeldLog;
    struct Opened {
        Result<PluginDevice> device;
        ovc_result code;
    };

    /// The device logs through it from any thread for as long as it lives, and may outlive this.
    std::shared_ptr<HeldLog> held_;
    std::future<Opened> opened_;
};

} // namespace ovc
