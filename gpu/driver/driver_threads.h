// SPDX-License-Identifier: Apache-2.0
// DriverThreads: the threads on which a software renderer runs kernels, and their clocks. Other
// work uses the same cores during a pass, so wall time says little about the kernel.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace ovc {

/// The name of the thread that opens devices. Threads that a driver starts from there inherit it,
/// unless the driver names them.
inline constexpr const char* kDeviceThreadName = "ovc-device";

/// Gives this thread that name.
void name_device_thread();

/// Lets this thread, and those that it starts, run on at most `count` (> 0) of the cores that it
/// may run on now. Does nothing where the system does not tell which these are (Linux does).
void keep_to_cores(uint32_t count);

class DriverThreads {
public:
    /// The driver's threads in this process now; none if the system does not list threads (Linux
    /// does). Call it on the thread that name_device_thread() has named.
    static DriverThreads find();

    void start();
    /// CPU seconds since start(), shared out evenly among the threads that have had work so far. So
    /// long the kernel would take if nothing else ran, since a driver deals work to any free
    /// thread. None if no thread has worked: the driver may have started others since find().
    std::optional<double> seconds_each() const;

private:
    std::vector<int> threads_;
    unsigned cores_ = 1; // that they may run on
    std::vector<double> started_;
};

} // namespace ovc
