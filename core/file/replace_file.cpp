// SPDX-License-Identifier: Apache-2.0
// replace_file(): writes a new file beside the other, under a name that nobody else takes, and
// renames it.
#include "core/file/replace_file.h"

#include "core/file/disk_file.h"
#include "core/text/format_text.h"

#include <atomic>
#include <cerrno>
#include <system_error>

#include <fcntl.h>
#include <unistd.h>

namespace ovc {

namespace fs = std::filesystem;

namespace {

struct Temporary {
    fs::path path;
    int descriptor = -1; // -1: the system refuses
};

/// Makes a new file in the folder of `path`, because rename() does not cross file systems.
Temporary create_beside(const fs::path& path) {
    static std::atomic<uint32_t> count{0};
    while (true) {
        fs::path name = path.parent_path() / format_text(".ovc-{}-{}", getpid(), count++);
        const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644);
        // A killed process leaves its names, and in another container one may have our number.
        if (file >= 0 || errno != EEXIST)
            return {std::move(name), file};
    }
}

} // namespace

bool replace_file(const fs::path& path, Bytes bytes) {
    const Temporary temporary = create_beside(path);
    if (temporary.descriptor < 0)
        return false;
    const bool written = append_to_file(temporary.descriptor, bytes) == 0;
    const bool closed = close(temporary.descriptor) == 0;
    std::error_code failed;
    if (written && closed)
        fs::rename(temporary.path, path, failed);
    const bool replaced = written && closed && !failed;
    if (!replaced)
        fs::remove(temporary.path, failed);
    return replaced;
}

} // namespace ovc
