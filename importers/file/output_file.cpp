// SPDX-License-Identifier: Apache-2.0
// OutputFile writes under a name that nobody else takes, then renames once.
#include "importers/file/output_file.h"

#include "core/file/disk_file.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cassert>
#include <cerrno>
#include <climits>
#include <csignal>
#include <cstdio>
#include <cstring>

namespace ovc {

namespace fs = std::filesystem;

namespace {

constexpr size_t kBufferBytes = size_t(1) << 18;
constexpr int kNamesTried = 100; // killed processes may have left some behind
constexpr int kMaxLinks = 40;    // the kernel's limit, too
constexpr mode_t kMode = 0666;   // less the user's mask

/// The file for remove_unfinished_output(), which a signal handler calls. The flag is false while
/// the name changes.
char unfinished_name[PATH_MAX];
volatile std::sig_atomic_t is_unfinished = 0;

void forget_unfinished() {
    is_unfinished = 0;
    std::atomic_signal_fence(std::memory_order_seq_cst);
}

void remember_unfinished(const fs::path& path) {
    forget_unfinished();
    // An absolute name survives a change of the working directory. A file whose name is too long is
    // not removed.
    std::error_code ec;
    const std::string name = fs::absolute(path, ec).string();
    if (ec || name.size() >= sizeof(unfinished_name))
        return;
    std::copy(name.c_str(), name.c_str() + name.size() + 1, unfinished_name);
    std::atomic_signal_fence(std::memory_order_seq_cst);
    is_unfinished = 1;
}

fs::path folder_of(const fs::path& path) {
    return path.has_parent_path() ? path.parent_path() : fs::path(".");
}

/// Returns the descriptor of standard output or error that goes to the file of `info`; else -1.
int standard_descriptor(const struct stat& info) {
    for (const int descriptor : {STDOUT_FILENO, STDERR_FILENO}) {
        struct stat other;
        if (fstat(descriptor, &other) == 0 && other.st_dev == info.st_dev &&
            other.st_ino == info.st_ino)
            return descriptor;
    }
    return -1;
}

bool is_written_through(const struct stat& info) {
    return S_ISCHR(info.st_mode) || S_ISFIFO(info.st_mode) || standard_descriptor(info) >= 0;
}

struct Temporary {
    fs::path path;
    int descriptor = -1; // errno says why there is none
};

/// Makes a new file in the target's folder, because rename() does not cross file systems. Its name
/// is short, so that it fits wherever the target's does.
Temporary create_beside(const fs::path& final_path) {
    for (int i = 0; i < kNamesTried; ++i) {
        fs::path path = folder_of(final_path) / fmt::format(".ovc{}-{}", getpid(), i);
        const int descriptor = open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, kMode);
        if (descriptor >= 0 || errno != EEXIST)
            return {std::move(path), descriptor};
    }
    return {};
}

const char* unfit_kind(const struct stat& info) {
    if (S_ISDIR(info.st_mode))
        return "a directory";
    if (S_ISBLK(info.st_mode))
        return "a block device";
    return S_ISSOCK(info.st_mode) && standard_descriptor(info) < 0 ? "a socket" : nullptr;
}

} // namespace

fs::path behind_links(fs::path path) {
    std::error_code ec;
    for (int i = 0; i < kMaxLinks && fs::is_symlink(path, ec); ++i) {
        const fs::path next = fs::read_symlink(path, ec);
        if (ec)
            break;
        path = next.is_absolute() ? next : folder_of(path) / next;
    }
    return path;
}

Result<Done> OutputFile::check(const fs::path& target) {
    if (const Result<Done> fine = check_place(target); !fine)
        return fine;
    struct stat info;
    if (stat(target.c_str(), &info) == 0 && is_written_through(info))
        return Done{};
    // Permissions do not tell everything: root may write to /proc, which takes no files.
    const Temporary probe = create_beside(behind_links(target));
    if (probe.descriptor < 0)
        return folder_refused(target, errno);
    close(probe.descriptor);
    unlink(probe.path.c_str());
    return Done{};
}

Result<Done> OutputFile::check_place(const fs::path& target) {
    struct stat info;
    if (stat(target.c_str(), &info) == 0) {
        if (const char* kind = unfit_kind(info))
            return Error{
                fmt::format("{}: found {}, expected a file to write", target.string(), kind)};
        if (standard_descriptor(info) >= 0)
            return Done{};
        if (is_written_through(info))
            return access(target.c_str(), W_OK) == 0 ? Result<Done>(Done{}) : failed(target, errno);
    } else if (errno != ENOENT && errno != ENOTDIR) {
        return failed(target, errno);
    }
    const fs::path folder = folder_of(behind_links(target));
    if (stat(folder.c_str(), &info) != 0)
        return Error{fmt::format("{}: the folder does not exist", target.string())};
    if (!S_ISDIR(info.st_mode))
        return Error{fmt::format("{}: {} is no folder", target.string(), folder.string())};
    if (access(folder.c_str(), W_OK | X_OK) != 0)
        return folder_refused(target, errno);
    return Done{};
}

Result<OutputFile> OutputFile::create(const fs::path& target) {
    if (const Result<Done> fine = check_place(target); !fine)
        return fine.error();
    struct stat info;
    if (stat(target.c_str(), &info) == 0 && is_written_through(info))
        return write_through(target);
    const fs::path final_path = behind_links(target);
    Temporary temporary = create_beside(final_path);
    if (temporary.descriptor < 0)
        return folder_refused(target, errno);
    remember_unfinished(temporary.path);
    return OutputFile(target, final_path, std::move(temporary.path), temporary.descriptor);
}

Result<OutputFile> OutputFile::go_on(const fs::path& target, const fs::path& unfinished,
                                     uint64_t offset) {
    if (const Result<Done> fine = check_place(target); !fine)
        return fine.error();
    OutputFile out(target, behind_links(target), unfinished,
                   open(unfinished.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, kMode));
    out.stays_ = true;
    if (out.file_.number() < 0 || lseek(out.file_.number(), off_t(offset), SEEK_SET) < 0)
        return failed(unfinished, errno);
    return out;
}

/// Duplicates the descriptor of standard output or error, because opening their file anew would
/// empty it.
Result<OutputFile> OutputFile::write_through(const fs::path& target) {
    struct stat info;
    const int standard = stat(target.c_str(), &info) == 0 ? standard_descriptor(info) : -1;
    if (standard >= 0)
        std::fflush(standard == STDOUT_FILENO ? stdout : stderr);
    const int descriptor =
        standard >= 0 ? fcntl(standard, F_DUPFD_CLOEXEC, 0)
                      : open(target.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, kMode);
    if (descriptor < 0)
        return failed(target, errno);
    return OutputFile(target, target, {}, descriptor);
}

void OutputFile::Descriptor::close() {
    if (number_ >= 0)
        ::close(std::exchange(number_, -1));
}

OutputFile::~OutputFile() {
    if (file_.number() < 0)
        return;
    file_.close();
    if (temporary_.empty() || stays_)
        return;
    std::error_code ec;
    fs::remove(temporary_, ec);
    forget_unfinished();
}

void OutputFile::write(const void* data, size_t size) {
    assert(file_.number() >= 0); // neither committed nor moved from
    const Bytes bytes(static_cast<const std::byte*>(data), size);
    if (waiting_.size() + size > kBufferBytes)
        hand_over_waiting();
    if (size > kBufferBytes)
        return hand_over(bytes);
    waiting_.reserve(kBufferBytes);
    waiting_.insert(waiting_.end(), bytes.begin(), bytes.end());
}

void OutputFile::hand_over(Bytes bytes) {
    if (error_number_ == 0)
        error_number_ = append_to_file(file_.number(), bytes);
}

void OutputFile::hand_over_waiting() {
    hand_over(waiting_);
    waiting_.clear();
}

Result<Done> OutputFile::flush() {
    assert(file_.number() >= 0);
    hand_over_waiting();
    return error_number_ == 0 ? Result<Done>(Done{}) : failed(target_, error_number_);
}

Result<Done> OutputFile::commit() {
    (void)flush();
    const int file = file_.number();
    // An unfinished file that was begun anew may be longer than what it has become.
    if (error_number_ == 0 && stays_ && ftruncate(file, lseek(file, 0, SEEK_CUR)) != 0)
        error_number_ = errno;
    if (!temporary_.empty()) {
        // fsync() comes before the rename, so that a crash leaves no empty file in the good one's
        // place.
        if (error_number_ == 0 && fsync(file) != 0 && errno != EINVAL)
            error_number_ = errno;
        if (error_number_ == 0 && std::rename(temporary_.c_str(), final_path_.c_str()) != 0)
            error_number_ = errno;
    }
    if (error_number_ != 0)
        return failed(target_, error_number_);
    if (!stays_)
        forget_unfinished();
    file_.close();
    return Done{};
}

Error OutputFile::failed(const fs::path& target, int error_number) {
    return {fmt::format("{}: cannot be written: {}", target.string(), std::strerror(error_number))};
}

Error OutputFile::folder_refused(const fs::path& target, int error_number) {
    return {fmt::format("{}: the folder cannot be written to: {}", target.string(),
                        std::strerror(error_number))};
}

bool is_same_output(const fs::path& a, const fs::path& b) {
    std::error_code ec;
    const fs::file_status status = fs::status(a, ec);
    if (fs::exists(status) && !fs::is_regular_file(status))
        return false;
    if (fs::equivalent(a, b, ec) && !ec)
        return true;
    const auto plain = [&](const fs::path& path) {
        return fs::weakly_canonical(fs::absolute(behind_links(path), ec), ec);
    };
    return plain(a) == plain(b);
}

void remove_unfinished_output() noexcept {
    if (is_unfinished)
        unlink(unfinished_name);
}

} // namespace ovc
