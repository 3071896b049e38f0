// SPDX-License-Identifier: Apache-2.0
// FilesRead stamps files by stat().
#include "importers/file/files_read.h"

#include <sys/stat.h>

namespace ovc {

FileStamp stamp_of(const std::filesystem::path& path) {
    std::error_code ec;
    FileStamp stamp{std::filesystem::absolute(path, ec).lexically_normal().string()};
    struct stat found {};
    if (stat(path.c_str(), &found) != 0 || !S_ISREG(found.st_mode))
        return stamp;
    stamp.exists = true;
    stamp.bytes = uint64_t(found.st_size);
    stamp.time_ns = int64_t(found.st_mtim.tv_sec) * 1'000'000'000 + found.st_mtim.tv_nsec;
    return stamp;
}

void FilesRead::add(FileStamp stamp) {
    if (!known_.insert(stamp.path).second)
        return;
    if (seen_)
        seen_(stamp);
    stamps_.push_back(std::move(stamp));
}

} // namespace ovc
