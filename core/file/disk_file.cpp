// SPDX-License-Identifier: Apache-2.0
// DiskFile: reads by pread.
#include "core/file/disk_file.h"

#include "core/text/suggestion.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ovc {

int read_file_as_far(int descriptor, uint64_t offset, std::span<std::byte> to, size_t& got) {
    for (got = 0; got < to.size();) {
        const ssize_t done =
            pread(descriptor, to.data() + got, to.size() - got, off_t(offset + got));
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return done < 0 ? errno : 0;
        got += size_t(done);
    }
    return 0;
}

int read_file(int descriptor, uint64_t offset, std::span<std::byte> to) {
    size_t got = 0;
    const int failed = read_file_as_far(descriptor, offset, to, got);
    return failed || got == to.size() ? failed : kFileEnded;
}

/// Passes all bytes to write(bytes that are left), a call of the system.
template <class Write>
static int write_all(Bytes bytes, Write&& write) {
    while (!bytes.empty()) {
        const ssize_t done = write(bytes);
        if (done < 0 && errno == EINTR)
            continue;
        if (done <= 0)
            return done < 0 ? errno : ENOSPC;
        bytes = bytes.subspan(size_t(done));
    }
    return 0;
}

int write_file(int descriptor, uint64_t offset, Bytes bytes) {
    const uint64_t end = offset + bytes.size();
    return write_all(bytes, [&](Bytes left) {
        return pwrite(descriptor, left.data(), left.size(), off_t(end - left.size()));
    });
}

int append_to_file(int descriptor, Bytes bytes) {
    return write_all(bytes,
                     [&](Bytes left) { return write(descriptor, left.data(), left.size()); });
}

Result<DiskFile> DiskFile::open(const std::filesystem::path& path) {
    const auto failed = [&](const std::string& sentence) {
        return Error{path.string() + ": " + sentence};
    };
    const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (descriptor < 0)
        return failed(errno == ENOENT ? "no such file" + did_you_mean_file(path)
                                      : std::string("cannot be opened: ") + std::strerror(errno));
    struct stat info {};
    const bool regular = fstat(descriptor, &info) == 0 && S_ISREG(info.st_mode);
    DiskFile file(path, descriptor, regular ? uint64_t(info.st_size) : 0);
    if (!regular)
        return failed("found no regular file");
    if (file.bytes_ == 0)
        return failed("the file is empty, expected a scene");
    return file;
}

DiskFile::~DiskFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
}

bool DiskFile::read(uint64_t offset, std::span<std::byte> to) const {
    const int failed = read_file(descriptor_, offset, to);
    int none = 0;
    if (failed)
        error_number_.compare_exchange_strong(none, failed);
    return failed == 0;
}

std::optional<std::string> DiskFile::failure() const {
    const int number = error_number_;
    if (number == 0)
        return std::nullopt;
    return number == kFileEnded ? "bytes are missing" : std::strerror(number);
}

std::optional<Error> DiskFile::error() const {
    const std::optional<std::string> why = failure();
    return why ? std::optional(Error{path_.string() + ": cannot be read: " + *why}) : std::nullopt;
}

} // namespace ovc
