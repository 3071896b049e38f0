// SPDX-License-Identifier: Apache-2.0
// MappedFile: maps a file by mmap.
#include "core/file/mapped_file.h"

#include "core/text/suggestion.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ovc {

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    const auto failed = [&](const std::string& sentence) {
        return Error{path.string() + ": " + sentence};
    };
    const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
    if (file < 0)
        return failed(errno == ENOENT ? "no such file" + did_you_mean_file(path)
                                      : std::string("cannot be opened: ") + std::strerror(errno));
    struct stat info {};
    const bool regular = fstat(file, &info) == 0 && S_ISREG(info.st_mode);
    const size_t size = regular ? size_t(info.st_size) : 0;
    void* at = size > 0 ? mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file, 0) : MAP_FAILED;
    const int error_number = errno;
    close(file);
    if (!regular)
        return failed("found no regular file");
    if (size == 0)
        return failed("the file is empty, expected a scene");
    if (at == MAP_FAILED)
        return failed(std::string("cannot be mapped: ") + std::strerror(error_number));
    return MappedFile({static_cast<const std::byte*>(at), size});
}

MappedFile::~MappedFile() {
    if (!bytes_.empty())
        munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

} // namespace ovc
