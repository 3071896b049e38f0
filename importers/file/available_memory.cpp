// SPDX-License-Identifier: Apache-2.0
// Linux tells of its memory in /proc/meminfo and in version 2 of control groups.
#include "importers/file/available_memory.h"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>

namespace ovc {

static constexpr uint64_t kUnknown = std::numeric_limits<uint64_t>::max();

static uint64_t system_bytes() {
    std::ifstream file("/proc/meminfo");
    std::string word;
    uint64_t kibibytes = 0;
    while (file >> word)
        if (word == "MemAvailable:" && file >> kibibytes)
            return kibibytes << 10;
    return kUnknown;
}

static uint64_t number_in(const std::string& path) {
    std::ifstream file(path);
    uint64_t value = 0;
    return file >> value ? value : kUnknown;
}

static uint64_t group_bytes() {
    std::ifstream file("/proc/self/cgroup");
    std::string line;
    while (std::getline(file, line))
        if (line.starts_with("0::")) {
            const std::string group = "/sys/fs/cgroup" + line.substr(3);
            const uint64_t limit = number_in(group + "/memory.max");
            const uint64_t used = number_in(group + "/memory.current");
            return limit == kUnknown || used == kUnknown ? kUnknown : limit - std::min(limit, used);
        }
    return kUnknown;
}

uint64_t available_memory() {
    return std::min(system_bytes(), group_bytes());
}

} // namespace ovc
