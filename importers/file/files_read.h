// SPDX-License-Identifier: Apache-2.0
// FilesRead: which files a scene was made from, and how they were then.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <unordered_set>
#include <vector>

namespace ovc {

/// A file at some time. Where there is none, bytes and time are 0.
struct FileStamp {
    std::string path; // absolute
    bool exists = false;
    uint64_t bytes = 0;
    int64_t time_ns = 0; // of its last change

    bool operator==(const FileStamp&) const = default;
};

/// Of the file as it is now; folders and devices count as none.
FileStamp stamp_of(const std::filesystem::path& path);

/// Files in the order in which they were first looked for, each once, stamped before they were
/// read.
class FilesRead {
public:
    void note(const std::filesystem::path& path);
    const std::vector<FileStamp>& stamps() const { return stamps_; }

private:
    std::vector<FileStamp> stamps_;
    std::unordered_set<std::string> known_;
};

/// Where nobody asks, `files` is null.
inline void note(FilesRead* files, const std::filesystem::path& path) {
    if (files)
        files->note(path);
}

} // namespace ovc
