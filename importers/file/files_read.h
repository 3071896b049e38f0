// SPDX-License-Identifier: Apache-2.0
// FilesRead records the files that a scene was made from, and how they were then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <unordered_set>
#include <utility>
#include <vector>

namespace ovc {

/// A file at some time. If it did not exist, bytes and time are 0.
struct FileStamp {
    std::string path; // absolute
    bool exists = false;
    uint64_t bytes = 0;
    int64_t time_ns = 0; // of its last change

    bool operator==(const FileStamp&) const = default;
};

/// Returns the stamp of the file as it is now; a folder or a device counts as no file.
FileStamp stamp_of(const std::filesystem::path& path);

/// Lists files in the order in which they were first looked for, each once, stamped before they
/// were read.
class FilesRead {
public:
    FilesRead() = default;
    /// seen: is told of each file, before it is read.
    explicit FilesRead(std::function<void(const FileStamp&)> seen) : seen_(std::move(seen)) {}

    void note(const std::filesystem::path& path) { add(stamp_of(path)); }
    void add(FileStamp stamp);
    const std::vector<FileStamp>& stamps() const { return stamps_; }

private:
    std::function<void(const FileStamp&)> seen_;
    std::vector<FileStamp> stamps_;
    std::unordered_set<std::string> known_;
};

/// Does nothing if `files` is null.
inline void note(FilesRead* files, const std::filesystem::path& path) {
    if (files)
        files->note(path);
}

} // namespace ovc
