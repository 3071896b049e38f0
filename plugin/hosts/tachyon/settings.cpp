// SPDX-License-Identifier: Apache-2.0
// Sizes in words, and the environment.
#include "plugin/hosts/tachyon/settings.h"

#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string_view>

namespace ovc::tachyon {

std::optional<uint64_t> bytes_of(const std::string& text) {
    if (text.empty() || text[0] < '0' || text[0] > '9')
        return std::nullopt;
    char* end = nullptr;
    errno = 0;
    const uint64_t number = std::strtoull(text.c_str(), &end, 10);
    const std::string_view unit = end;
    const size_t power = unit.empty() ? 0 : std::string_view("KMG").find(unit) + 1;
    if (errno != 0 || unit.size() > 1 || (!unit.empty() && power == 0) || number == 0 ||
        number > UINT64_MAX >> (10 * power))
        return std::nullopt;
    return number << (10 * power);
}

std::string no_bytes(const std::string& name, const std::string& text) {
    return name + " " + text + " is no number of bytes; expected such as 256M";
}

Settings settings_from_environment() {
    Settings settings;
    if (const char* device = std::getenv(kDevice))
        settings.device = device;
    if (const char* text = std::getenv(kGpuMemory)) {
        const std::optional<uint64_t> bytes = bytes_of(text);
        if (!bytes)
            throw std::runtime_error(no_bytes(kGpuMemory, text));
        settings.gpu_memory_bytes = *bytes;
    }
    return settings;
}

} // namespace ovc::tachyon
