// SPDX-License-Identifier: Apache-2.0
// MappedFile: a file as memory, which the system reads when it is touched.
#pragma once

#include "core/file/archive.h"
#include "core/result.h"

#include <filesystem>
#include <utility>

namespace ovc {

/// Changing the file's bytes in place changes them here as well, and a file that is cut shorter
/// faults when touched. Replacing it by another file of its name does neither.
class MappedFile {
public:
    /// Returns the file as memory. Error, which names the file: none, not regular, or empty.
    static Result<MappedFile> open(const std::filesystem::path& path);

    /// Holds no file.
    MappedFile() = default;
    MappedFile(MappedFile&& other) noexcept : bytes_(std::exchange(other.bytes_, {})) {}
    MappedFile& operator=(MappedFile&& other) noexcept {
        std::swap(bytes_, other.bytes_);
        return *this;
    }
    ~MappedFile();

    /// Returns the file's bytes, aligned to pages of memory; valid as long as this object.
    Bytes bytes() const { return bytes_; }

private:
    explicit MappedFile(Bytes bytes) : bytes_(bytes) {}

    Bytes bytes_;
};

} // namespace ovc
