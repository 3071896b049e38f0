// SPDX-License-Identifier: Apache-2.0
// MappedFile: maps a file by mmap.
#include "core/file/mapped_file.h"

#include "core/file/disk_file.h"

#include <cerrno>
#include <cstring>

#include <sys/mman.h>

namespace ovc {

Result<MappedFile> MappedFile::open(const std::filesystem::path& path) {
    const Result<DiskFile> file = DiskFile::open(path);
    if (!file)
        return file.error();
    const size_t size = size_t(file->bytes());
    void* const at = mmap(nullptr, size, PROT_READ, MAP_PRIVATE, file->descriptor(), 0);
    if (at == MAP_FAILED)
        return Error{path.string() + ": cannot be mapped: " + std::strerror(errno)};
    return MappedFile({static_cast<const std::byte*>(at), size});
}

MappedFile::~MappedFile() {
    if (!bytes_.empty())
        munmap(const_cast<std::byte*>(bytes_.data()), bytes_.size());
}

} // namespace ovc
