// SPDX-License-Identifier: Apache-2.0
// Finds real scenes for tests. They are third-party files that are never part of the project.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

namespace ovc {

inline constexpr const char* kNoRealData = "no real data: neither $OVC_DATA nor ../shared/data has "
                                           "a script `unpack` that works (it needs zstd)";

/// Returns the folder that holds the index of the real data: $OVC_DATA, or ../shared/data beside
/// the sources.
inline std::filesystem::path real_data_index() {
    const char* data = std::getenv("OVC_DATA");
    return data ? data : OVC_SOURCE_DIR "/../shared/data";
}

/// Returns the folder with meshes/ pbrt/ pov/ torture/. The first call of any process unpacks it
/// into the build folder. Returns nothing if there is none; tests then GTEST_SKIP() << kNoRealData.
inline std::optional<std::filesystem::path> real_data() {
    namespace fs = std::filesystem;
    const fs::path folder = OVC_BINARY_DIR "/real_data";
    const fs::path unpack = real_data_index() / "unpack";
    if (!fs::exists(unpack))
        return std::nullopt;
    fs::create_directories(folder);
    // Tests run side by side as processes. One unpacks while the others wait.
    const int lock = open((folder.string() + ".lock").c_str(), O_CREAT | O_RDWR | O_CLOEXEC, 0644);
    if (lock < 0 || flock(lock, LOCK_EX) != 0)
        return std::nullopt;
    std::string command = unpack.string();
    command.append(" ").append(folder.string()).append(" >&2");
    const bool unpacked = fs::exists(folder / ".unpacked") || std::system(command.c_str()) == 0;
    close(lock);
    return unpacked ? std::optional(folder) : std::nullopt;
}

} // namespace ovc
