// SPDX-License-Identifier: Apache-2.0
// The CPU time and the memory, as Linux tells it, that this process has taken so far.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include <time.h>

namespace ovc {

/// Returns the CPU time of all threads.
inline double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// Returns resident memory, or 0 where the system does not tell. field: VmHWM for its maximum so
/// far, VmRSS for now.
inline uint64_t resident_bytes(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (uint64_t kilobytes = 0; word == field + ":" && status >> kilobytes)
            return kilobytes << 10;
    return 0;
}

} // namespace ovc
