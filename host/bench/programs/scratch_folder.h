// SPDX-License-Identifier: Apache-2.0
// ScratchFolder: a folder for temporary files, which the destructor removes.
#pragma once

#include "core/result.h"

#include <stdlib.h>

#include <filesystem>
#include <string>
#include <utility>

namespace ovc {

class ScratchFolder {
public:
    /// Makes a folder in TMPDIR, or in /tmp. Error: it cannot be made.
    static Result<ScratchFolder> make() {
        std::error_code failed;
        std::string path = std::filesystem::temp_directory_path(failed) / "overcast_bench_XXXXXX";
        if (failed || !mkdtemp(path.data()))
            return Error{"no folder for temporary files can be made in " + path};
        return ScratchFolder(path);
    }
    ScratchFolder(ScratchFolder&& other) noexcept : path_(std::exchange(other.path_, {})) {}
    ScratchFolder& operator=(ScratchFolder&&) = delete;
    ~ScratchFolder() {
        std::error_code ignored;
        if (!path_.empty())
            std::filesystem::remove_all(path_, ignored);
    }

    const std::filesystem::path& path() const { return path_; }

private:
    explicit ScratchFolder(std::filesystem::path path) : path_(std::move(path)) {}
    std::filesystem::path path_;
};

} // namespace ovc
