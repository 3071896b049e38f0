// SPDX-License-Identifier: Apache-2.0
// The machine of a measurement, and what else it did meanwhile.
#pragma once

#include <cstdint>
#include <string>

namespace ovc {

struct MachineText {
    std::string processor; // "AMD EPYC 9R14"; empty where Linux does not tell
    uint32_t threads = 0;
    uint64_t memory_bytes = 0;
    std::string system; // "Linux 6.1.0 x86_64"
};

MachineText describe_machine();

/// Returns the system's load average over one minute, or 0 where it does not tell.
double load_average();

/// Tells how busy other programs kept the machine, from its making on.
class OtherLoad {
public:
    OtherLoad();
    /// Returns how many cores all programs used on average, less those of `own_cpu_seconds`; 0
    /// where the system does not tell.
    double cores(double own_cpu_seconds) const;

private:
    double busy_;    // CPU seconds of all programs since the machine was started
    double seconds_; // of the wall's clock
};

} // namespace ovc
