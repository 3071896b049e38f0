// SPDX-License-Identifier: Apache-2.0
// A step is its number of bytes, their checksum, and they. The first names the work.
#include "importers/file/step_file.h"

#include "core/file/disk_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

namespace ovc {
namespace {

struct Head {
    uint64_t bytes;
    uint64_t checksum;
};

} // namespace

Result<StepFile> StepFile::open(const std::filesystem::path& path, std::string_view work) {
    const int descriptor = ::open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
    if (descriptor < 0)
        return Error{fmt::format("{}: cannot be written: {}", path.string(), std::strerror(errno))};
    StepFile file(path, work, descriptor);
    if (flock(descriptor, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK)
        return Error{fmt::format("{}: another process is at this work", path.string())};
    file.read_steps();
    if (ftruncate(descriptor, off_t(file.end_)) != 0) {
        file.fail(errno);
        return *file.error();
    }
    const Bytes name = bytes_of(std::span<const char>(work));
    if (!file.steps_.empty() && std::ranges::equal(file.steps_.front(), name))
        file.steps_.erase(file.steps_.begin());
    else if (!file.begin_anew())
        return *file.error();
    return file;
}

StepFile::~StepFile() {
    if (descriptor_ >= 0)
        close(descriptor_);
}

/// Believes nothing that it reads.
void StepFile::read_steps() {
    struct stat info {};
    const uint64_t size = fstat(descriptor_, &info) == 0 ? uint64_t(info.st_size) : 0;
    Head head{};
    while (size - end_ >= sizeof(head)) {
        if (read_file(descriptor_, end_, std::as_writable_bytes(std::span(&head, 1))) != 0 ||
            head.bytes > size - end_ - sizeof(head))
            return;
        std::vector<std::byte> step(head.bytes);
        if (read_file(descriptor_, end_ + sizeof(head), step) != 0 ||
            checksum_of(step) != head.checksum)
            return;
        steps_.push_back(std::move(step));
        end_ += sizeof(head) + head.bytes;
    }
}

bool StepFile::begin_anew() {
    steps_.clear();
    end_ = 0;
    if (ftruncate(descriptor_, 0) != 0)
        return fail(errno);
    const bool named = keep(bytes_of(std::span<const char>(work_)));
    steps_.clear();
    return named;
}

/// One that a kill cuts short lies behind end_ the next time.
bool StepFile::keep(Bytes step) {
    const Head head{step.size(), checksum_of(step)};
    std::vector<std::byte> bytes(sizeof(head) + step.size());
    std::memcpy(bytes.data(), &head, sizeof(head));
    std::ranges::copy(step, bytes.begin() + sizeof(head));
    if (const int failed = write_file(descriptor_, end_, bytes))
        return fail(failed);
    end_ += bytes.size();
    steps_.emplace_back(step.begin(), step.end());
    return true;
}

bool StepFile::fail(int error_number) {
    if (error_number_ == 0)
        error_number_ = error_number;
    return false;
}

std::optional<Error> StepFile::error() const {
    if (error_number_ == 0)
        return std::nullopt;
    return Error{
        fmt::format("{}: cannot be written: {}", path_.string(), std::strerror(error_number_))};
}

} // namespace ovc
