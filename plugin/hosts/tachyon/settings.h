// SPDX-License-Identifier: Apache-2.0
// The settings of overcast-tachyon, which come to the library in the environment.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace ovc::tachyon {

inline constexpr const char* kDevice = "OVC_TACHYON_DEVICE";
inline constexpr const char* kGpuMemory = "OVC_TACHYON_GPU_MEMORY";

struct Settings {
    std::string device;            // empty: the first GPU, else the software renderer
    uint64_t gpu_memory_bytes = 0; // 0: the device's default
};

/// A number above 0, perhaps with K, M or G (1024 of the one before) behind it; nothing for
/// anything else.
std::optional<uint64_t> bytes_of(const std::string& text);

/// The sentence about a text that bytes_of() does not take; `name` says where it stood.
std::string no_bytes(const std::string& name, const std::string& text);

/// Throws std::runtime_error with that sentence.
Settings settings_from_environment();

} // namespace ovc::tachyon
