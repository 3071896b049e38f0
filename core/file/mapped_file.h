// SPDX-License-Identifier: Apache-2.0
// MappedFile: a file as memory, read by the system when it is touched.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <filesystem>
#include <utility>

namespace ovc {

/// Whoever changes the file's bytes in place changes them here as well; one that is cut shorter
/// faults when touched. Replacing it by another file of its name does neither.
class MappedFile {
public:
    /// Error: none, no regular file, or empty; the sentence names it.
    static Result<MappedFile> open(const std::filesystem::path& path);

    /// No file.
    MappedFile() = default;
    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~MappedFile();

    /// Aligned to pages of memory.
    Bytes bytes() const { return bytes_; }

private:
    explicit MappedFile(Bytes bytes) : bytes_(bytes) {}

    Bytes bytes_;
};

} // namespace ovc
