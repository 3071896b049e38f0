// SPDX-License-Identifier: Apache-2.0
// ScratchFile is made by O_TMPFILE, or removed as soon as it is made where a file system has no
// such files.
#include "importers/scratch/scratch_file.h"

#include "core/file/disk_file.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string>

#include <fcntl.h>
#include <unistd.h>

namespace ovc {
namespace {

int open_nameless(const std::filesystem::path& folder) {
    const int descriptor = open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
    if (descriptor >= 0 || (errno != EOPNOTSUPP && errno != EISDIR && errno != EINVAL))
        return descriptor;
    std::string name = (folder / ".ovcXXXXXX").string();
    const int named = mkostemp(name.data(), O_CLOEXEC);
    if (named >= 0)
        unlink(name.c_str());
    return named;
}

} // namespace

Result<ScratchFile> ScratchFile::create(const std::filesystem::path& folder) {
    const std::filesystem::path place = folder.empty() ? "." : folder;
    const int descriptor = open_nameless(place);
    if (descriptor < 0)
        return Error{fmt::format("{}: no scratch file can be made there: {}", place.string(),
                                 std::strerror(errno))};
    return ScratchFile(place, descriptor);
}

Result<ScratchFile> ScratchFile::open_named(const std::filesystem::path& path) {
    const int descriptor = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0600);
    if (descriptor < 0)
        return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
    return ScratchFile(path.has_parent_path() ? path.parent_path() : ".", descriptor);
}

ScratchFile::~ScratchFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
}

bool ScratchFile::fail(int error_number) {
    int none = 0;
    error_number_.compare_exchange_strong(none, error_number);
    return false;
}

bool ScratchFile::write(uint64_t offset, Bytes bytes) {
    const int failed = write_file(descriptor_, offset, bytes);
    return failed == 0 || fail(failed);
}

bool ScratchFile::read(uint64_t offset, std::span<std::byte> bytes) {
    const int failed = read_file(descriptor_, offset, bytes);
    return failed == 0 || fail(failed);
}

std::optional<Error> ScratchFile::error() const {
    const int number = error_number_;
    if (number == 0)
        return std::nullopt;
    return Error{fmt::format("{}: the scratch file there failed: {}", folder_.string(),
                             number == kFileEnded ? "bytes are missing" : std::strerror(number))};
}

} // namespace ovc
