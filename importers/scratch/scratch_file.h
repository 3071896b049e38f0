// SPDX-License-Identifier: Apache-2.0
// ScratchFile has no name, so that the system frees it however the process ends, unless a later
// process is to find it.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <utility>

namespace ovc {

/// A file of any size in a folder. Any number of threads may use it at once.
class ScratchFile {
public:
    /// Error: the folder does not exist or takes no files.
    static Result<ScratchFile> create(const std::filesystem::path& folder);

    /// Opens a file of this name, which stays, or makes it. Error: it cannot be written.
    static Result<ScratchFile> open_named(const std::filesystem::path& path);

    ScratchFile(ScratchFile&& other) noexcept
        : folder_(std::move(other.folder_)),
          descriptor_(std::exchange(other.descriptor_, -1)),
          error_number_(other.error_number_.load()) {}
    ScratchFile& operator=(ScratchFile&&) = delete;
    ~ScratchFile();

    /// Both return false where the system refuses; error() then says why.
    bool write(uint64_t offset, Bytes bytes);
    bool read(uint64_t offset, std::span<std::byte> bytes);

    /// Returns the first failure; nothing where there was none.
    std::optional<Error> error() const;

private:
    ScratchFile(std::filesystem::path folder, int descriptor)
        : folder_(std::move(folder)), descriptor_(descriptor) {}

    bool fail(int error_number);

    std::filesystem::path folder_;
    int descriptor_;
    std::atomic<int> error_number_{0}; // of the first failure; or kFileEnded
};

} // namespace ovc
