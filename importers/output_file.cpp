// SPDX-License-Identifier: Apache-2.0
// OutputFile: a name nobody else takes, then one rename.
#include "importers/output_file.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace ovc {

namespace {

constexpr size_t kBufferBytes = size_t(1) << 18;
constexpr int kNamesTried = 100; // left behind by processes that were killed

} // namespace

Result<OutputFile> OutputFile::create(const std::filesystem::path& target) {
    std::error_code ec;
    if (std::filesystem::is_directory(target, ec))
        return Error{
            fmt::format("{}: found a directory, expected a file to write", target.string())};
    const auto folder = target.has_parent_path() ? target.parent_path() : ".";
    if (!std::filesystem::is_directory(folder, ec))
        return Error{fmt::format("{}: the folder does not exist", target.string())};
    for (int i = 0; i < kNamesTried; ++i) {
        auto temporary = target;
        temporary += fmt::format(".{}-{}.part", getpid(), i);
        if (std::FILE* file = std::fopen(temporary.c_str(), "wbx")) {
            std::setvbuf(file, nullptr, _IOFBF, kBufferBytes);
            return OutputFile(target, std::move(temporary), file);
        }
        if (errno != EEXIST)
            break;
    }
    return Error{fmt::format("{}: cannot be written: {}", target.string(), std::strerror(errno))};
}

OutputFile::~OutputFile() {
    if (!file_)
        return;
    file_.reset();
    std::error_code ec;
    std::filesystem::remove(temporary_, ec);
}

void OutputFile::write(const void* data, size_t bytes) {
    if (error_number_ == 0 && std::fwrite(data, 1, bytes, file_.get()) != bytes)
        error_number_ = errno;
}

Result<Done> OutputFile::commit() {
    if (error_number_ == 0 && std::fflush(file_.get()) != 0)
        error_number_ = errno;
    // Before the rename: a crash must not leave an empty file in the good one's place.
    if (error_number_ == 0 && fsync(fileno(file_.get())) != 0 && errno != EINVAL)
        error_number_ = errno;
    if (error_number_ == 0 && std::rename(temporary_.c_str(), target_.c_str()) != 0)
        error_number_ = errno;
    if (error_number_ != 0)
        return failed();
    file_.reset();
    return Done{};
}

Error OutputFile::failed() const {
    return {
        fmt::format("{}: cannot be written: {}", target_.string(), std::strerror(error_number_))};
}

} // namespace ovc
