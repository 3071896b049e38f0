// SPDX-License-Identifier: Apache-2.0
// DriverThreads: the threads on which a software renderer runs kernels, and their clocks. Other
// work goes on beside a pass on the same cores, so the wall's clock says little of the kernel.
#pragma once

#include <optional>
#include <vector>

namespace ovc {

/// What the thread that opens devices is called; threads that a driver starts there inherit it,
/// unless it names them.
inline constexpr const char* kDeviceThreadName = "ovc-device";

/// Calls this thread so.
void name_device_thread();

class DriverThreads {
public:
    /// Those of this process now; none where the system does not tell (Linux does). Called on a
    /// thread of that name.
    static DriverThreads find();

    void start();
    /// CPU seconds since start(), shared out evenly among the threads that have had work so far:
    /// how long the kernel takes where nothing else runs, since work is dealt to whoever is free.
    /// None where none of them has worked: the driver may have started others since find().
    std::optional<double> seconds_each() const;

private:
    std::vector<int> threads_;
    std::vector<double> started_;
};

} // namespace ovc
