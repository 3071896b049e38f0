// SPDX-License-Identifier: Apache-2.0
// DiskFile: a file of which parts are read when they are asked for.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <atomic>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace ovc {

/// Fills `to` with a file's bytes from an offset on, as far as the file goes; `got` receives how
/// many there were. Returns 0, or the error number of the system.
int read_file_as_far(int descriptor, uint64_t offset, std::span<std::byte> to, size_t& got);

/// Fills `to` with a file's bytes from an offset on. Returns 0, the error number of the system, or
/// kFileEnded where bytes are missing.
inline constexpr int kFileEnded = -1;
int read_file(int descriptor, uint64_t offset, std::span<std::byte> to);

/// Writes bytes to a file from an offset on. Returns 0, or the error number of the system.
int write_file(int descriptor, uint64_t offset, Bytes bytes);

/// Writes bytes to a file, a pipe or a device where it stands. Returns 0, or the error number of
/// the system.
int append_to_file(int descriptor, Bytes bytes);

/// A file that is cut shorter, or that its disk cannot give, is noted. Any number of threads may
/// read.
class DiskFile {
public:
    /// Error, which names the file: none, not regular, or empty.
    static Result<DiskFile> open(const std::filesystem::path& path);

    DiskFile(DiskFile&& other) noexcept
        : path_(std::move(other.path_)),
          descriptor_(std::exchange(other.descriptor_, -1)),
          bytes_(other.bytes_),
          error_number_(other.error_number_.load()) {}
    DiskFile& operator=(DiskFile&&) = delete;
    ~DiskFile();

    uint64_t bytes() const { return bytes_; }
    /// Returns the system's number of the file, which stays open while this lives.
    int descriptor() const { return descriptor_; }
    /// Returns false where the system refuses; error() then says why.
    bool read(uint64_t offset, std::span<std::byte> to) const;
    const std::filesystem::path& path() const { return path_; }
    /// Returns why the first read that failed did; nothing where none has.
    std::optional<std::string> failure() const;
    /// Returns the same as a sentence that names the file.
    std::optional<Error> error() const;

private:
    DiskFile(std::filesystem::path path, int descriptor, uint64_t bytes)
        : path_(std::move(path)), descriptor_(descriptor), bytes_(bytes) {}

    std::filesystem::path path_;
    int descriptor_;
    uint64_t bytes_;
    mutable std::atomic<int> error_number_{0};
};

} // namespace ovc
