// SPDX-License-Identifier: Apache-2.0
// Reads /proc/cpuinfo and /proc/stat.
#include "host/doctor/machine_load.h"

#include "core/system/parallel.h"

#include <fmt/format.h>
#include <stdlib.h>
#include <sys/utsname.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>

namespace ovc {

MachineText describe_machine() {
    MachineText machine;
    std::ifstream info("/proc/cpuinfo");
    for (std::string line; machine.processor.empty() && std::getline(info, line);)
        if (const size_t colon = line.find(": ");
            line.starts_with("model name") && colon != std::string::npos)
            machine.processor = line.substr(colon + 2);
    machine.threads = uint32_t(thread_count());
    machine.memory_bytes = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    if (utsname name{}; uname(&name) == 0)
        machine.system = fmt::format("{} {} {}", name.sysname, name.release, name.machine);
    return machine;
}

double load_average() {
    double load = 0;
    return getloadavg(&load, 1) == 1 ? load : 0;
}

/// Sums the first line of /proc/stat without its idle columns, the fourth and the fifth. Guests'
/// time, from the ninth on, is in the others.
static double busy_seconds() {
    std::ifstream stat("/proc/stat");
    std::string word;
    stat >> word;
    double ticks = 0, one = 0;
    for (int column = 1; column <= 8 && stat >> one; ++column)
        ticks += column == 4 || column == 5 ? 0 : one;
    return ticks / double(sysconf(_SC_CLK_TCK));
}

static double wall_seconds() {
    timespec now{};
    clock_gettime(CLOCK_MONOTONIC, &now);
    return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}

OtherLoad::OtherLoad() : busy_(busy_seconds()), seconds_(wall_seconds()) {}

double OtherLoad::cores(double own_cpu_seconds) const {
    const double seconds = wall_seconds() - seconds_;
    return seconds > 0 ? std::max(0.0, (busy_seconds() - busy_ - own_cpu_seconds) / seconds) : 0;
}

} // namespace ovc
