// SPDX-License-Identifier: AGPL-3.0-or-later
#include "plugin/hosts/povray/overcast_settings.h"

#include <cstdlib>
#include <filesystem>
#include <stdexcept>

namespace fs = std::filesystem;

static std::string variable(const char* name) {
    const char* text = std::getenv(name);
    return text ? text : "";
}

/// The whole number that the text begins with, and in `unit` what follows it.
static uint64_t number_in(const char* name, const std::string& text, const char* expected,
                          std::string& unit) {
    const size_t digits = std::min(text.find_first_not_of("0123456789"), text.size());
    if (digits == 0 || digits > 18)
        throw std::runtime_error(std::string(name) + " is '" + text + "', expected " + expected);
    unit = text.substr(digits);
    return std::stoull(text.substr(0, digits));
}

static uint64_t bytes_of(const char* name, const std::string& text) {
    const char* expected = "bytes, such as 256M";
    const std::string units = "KMG";
    std::string unit;
    const uint64_t number = number_in(name, text, expected, unit);
    const size_t power = unit.empty() ? 0 : 1 + units.find(unit);
    if (unit.size() > 1 || (!unit.empty() && power == 0) || number > UINT64_MAX >> (10 * power))
        throw std::runtime_error(std::string(name) + " is '" + text + "', expected " + expected);
    return number << (10 * power);
}

static long triangles_of(const char* name, const std::string& text) {
    const char* expected = "a number of triangles";
    std::string unit;
    const uint64_t number = number_in(name, text, expected, unit);
    if (!unit.empty())
        throw std::runtime_error(std::string(name) + " is '" + text + "', expected " + expected);
    return long(number);
}

static std::string library_beside_program() {
    const char* name = "libovercast.so";
    std::error_code error;
    const fs::path folder = fs::read_symlink("/proc/self/exe", error).parent_path();
    for (const fs::path& path : {folder / name, folder.parent_path() / "lib" / name})
        if (!error && fs::exists(path, error))
            return path;
    return name;
}

OvercastSettings overcast_settings() {
    OvercastSettings settings;
    settings.library = variable("OVC_PLUGIN");
    if (settings.library.empty())
        settings.library = library_beside_program();
    settings.device = variable("OVC_POVRAY_DEVICE");
    if (const std::string text = variable("OVC_POVRAY_GPU_MEMORY"); !text.empty())
        settings.gpu_memory_bytes = bytes_of("OVC_POVRAY_GPU_MEMORY", text);
    if (const std::string text = variable("OVC_POVRAY_TRIANGLES"); !text.empty())
        settings.min_triangles = triangles_of("OVC_POVRAY_TRIANGLES", text);
    return settings;
}
