// SPDX-License-Identifier: AGPL-3.0-or-later
// OvercastDevice: libovercast.so, loaded, and a device of it; shared by all meshes.
#pragma once

#include "plugin/hosts/povray/overcast_settings.h"
#include "plugin/overcast.h"

#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>

/// Why Overcast cannot have a mesh, or could not answer a ray: its own sentence.
struct OvercastFailure : std::runtime_error {
    using std::runtime_error::runtime_error;
};

class OvercastDevice {
public:
    /// Returns the device that is open, or a new one. POV-Ray's meshes share it from any thread and
    /// end in any order, and the last of them closes it. Throws OvercastFailure, the same one again
    /// where opening has failed before.
    static std::shared_ptr<OvercastDevice> open(const OvercastSettings& settings);

    explicit OvercastDevice(const OvercastSettings& settings);
    ~OvercastDevice();
    OvercastDevice(const OvercastDevice&) = delete;
    OvercastDevice& operator=(const OvercastDevice&) = delete;

    const ovc_api& api() const { return *api_; }
    ovc_device handle() const { return device_; }
    /// GPU memory that suits a mesh of so many triangles: meshes share the device's, and the
    /// library's own default is for one scene alone.
    uint64_t budget_for(long triangles) const;

    /// To be told at the end, when the device is closed.
    void count(long triangles, uint64_t rays);

    /// Throws OvercastFailure with the library's sentence unless the result is OVC_OK.
    void check(ovc_result result) const {
        if (result != OVC_OK)
            throw OvercastFailure(api_->last_error(device_));
    }

private:
    const ovc_api* api_;
    ovc_device device_ = nullptr;
    ovc_device_info info_{};
    std::mutex counting_;
    uint64_t meshes_ = 0;
    uint64_t triangles_ = 0;
    uint64_t rays_ = 0;
};
