// SPDX-License-Identifier: Apache-2.0
// What this process has cost so far: CPU time, and memory as Linux tells it.
#pragma once

#include <cstdint>
#include <fstream>
#include <string>

#include <time.h>

namespace ovc {

/// Of all threads.
inline double process_cpu_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

/// field: VmHWM, the most memory that was resident, or VmRSS, what is resident now. 0 where the
/// system does not tell.
inline uint64_t resident_bytes(const std::string& field) {
    std::ifstream status("/proc/self/status");
    for (std::string word; status >> word;)
        if (uint64_t kilobytes = 0; word == field + ":" && status >> kilobytes)
            return kilobytes << 10;
    return 0;
}

} // namespace ovc
