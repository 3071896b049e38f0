// SPDX-License-Identifier: Apache-2.0
// The child process writes a scene file, or the sentence of an error, into a file in memory.
#include "importers/scene_file/read_apart.h"

#include "importers/file/available_memory.h"
#include "importers/scene_file/scene_file.h"

#include <fmt/format.h>

#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fstream>
#include <iterator>
#include <new>
#include <optional>
#include <span>
#include <utility>

namespace ovc {

namespace {

/// How the child ends that has written a scene, or a sentence. Sanitizers end it with 1.
constexpr int kWroteScene = 0, kWroteError = 2, kWroteNothing = 3;

class MemoryFile {
public:
    MemoryFile() : descriptor_(memfd_create("overcast scene", MFD_CLOEXEC)) {}
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;
    ~MemoryFile() {
        if (exists())
            close(descriptor_);
    }

    bool exists() const { return descriptor_ >= 0; }
    std::string path() const { return fmt::format("/proc/self/fd/{}", descriptor_); }

    bool write(Bytes bytes) const {
        while (!bytes.empty()) {
            const ssize_t written = ::write(descriptor_, bytes.data(), bytes.size());
            if (written < 0 && errno != EINTR)
                return false;
            bytes = bytes.subspan(size_t(std::max<ssize_t>(written, 0)));
        }
        return true;
    }

private:
    const int descriptor_;
};

/// Returns the bytes of private memory that this process has, as RLIMIT_DATA counts them.
uint64_t own_bytes() {
    std::ifstream file("/proc/self/statm");
    uint64_t pages = 0;
    for (int word = 0; word < 6; ++word)
        file >> pages;
    return pages * uint64_t(sysconf(_SC_PAGESIZE));
}

void limit(int resource, uint64_t max) {
    rlimit limits{};
    if (getrlimit(__rlimit_resource_t(resource), &limits) != 0)
        return;
    limits.rlim_cur = std::min<rlim_t>(limits.rlim_max, max);
    setrlimit(__rlimit_resource_t(resource), &limits);
}

/// The memory of the child beyond that of its parent, and its time. Damaged files make readers loop
/// without end, and until no memory is left, however much there is.
class Limits {
public:
    void set() const {
        if (free_ < kUnlimited)
            limit(RLIMIT_DATA, own_ + std::min(kBytes + kBytesOfByte * file_bytes_, free_));
        limit(RLIMIT_CPU, kSeconds + file_bytes_ / kBytesOfSecond);
    }

    /// Raises the limits by what a reader may make of a file of so many bytes.
    void add_file(uint64_t bytes) {
        file_bytes_ += std::min(bytes, kUnlimited / kBytesOfByte);
        set();
    }

private:
    /// Compressed files, and texts that Assimp makes a tree of, come to 100 times their bytes. It
    /// reads a megabyte and more a second.
    static constexpr uint64_t kBytes = uint64_t(1) << 30, kBytesOfByte = 200;
    static constexpr uint64_t kSeconds = 60, kBytesOfSecond = 50'000;
    static constexpr uint64_t kUnlimited = uint64_t(1) << 50; // no machine has more

    const uint64_t own_ = own_bytes(), free_ = available_memory();
    uint64_t file_bytes_ = 0;
};

/// Lets the child end with its parent, by any signal, and without a core file.
void leave_to_signals() {
    for (int signal = 1; signal < NSIG; ++signal)
        std::signal(signal, SIG_DFL); // the parent's handlers act for the parent
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    limit(RLIMIT_CORE, 0);
}

/// Reads and writes as the child does, and returns how it is to end.
int read_into(const MemoryFile& file, SceneReader read, const std::filesystem::path& path,
              ImportOptions options) try {
    Provenance from;
    Limits limits;
    limits.set();
    FilesRead files([&](const FileStamp& stamp) { limits.add_file(stamp.bytes); });
    options.files = &files;
    options.log = [&](LogLevel level, const std::string& message) {
        if (level == LogLevel::Warning)
            from.warnings.push_back(message);
    };
    const Result<Scene> scene = read(path, options);
    from.files = files.stamps();
    const ByteSink sink = [&](Bytes bytes) { return file.write(bytes); };
    if (scene)
        return write_scene(*scene, from, sink) ? kWroteScene : kWroteNothing;
    const std::string& sentence = scene.error().message;
    return file.write(std::as_bytes(std::span(sentence))) ? kWroteError : kWroteNothing;
} catch (const std::bad_alloc&) {
    return kWroteNothing; // no error is left that could be written
}

Result<Scene> scene_in(const MemoryFile& file, const ImportOptions& options) {
    Result<SceneFile> read = read_scene_file(file.path());
    if (!read)
        return read.error();
    for (const std::string& warning : read->from.warnings)
        say(options.log, LogLevel::Warning, warning);
    for (FileStamp& stamp : read->from.files)
        if (options.files)
            options.files->add(std::move(stamp));
    return std::move(read->scene);
}

/// Returns the status with which a child has ended; nothing where the system does not tell.
std::optional<int> wait_for(pid_t child) {
    int status = 0;
    while (waitpid(child, &status, 0) != child)
        if (errno != EINTR)
            return std::nullopt;
    return status;
}

} // namespace

Result<Scene> read_apart(SceneReader read, std::string_view name, const std::filesystem::path& path,
                         const ImportOptions& options) {
    const MemoryFile file;
    const pid_t child = file.exists() ? fork() : -1;
    if (child < 0)
        return read(path, options);
    if (child == 0) {
        leave_to_signals();
        _exit(read_into(file, read, path, options));
    }
    const std::optional<int> status = wait_for(child);
    if (!status) { // the system itself reaps the children of a process that ignores SIGCHLD
        Result<Scene> scene = scene_in(file, options);
        return scene ? std::move(scene) : read(path, options);
    }
    if (WIFSIGNALED(*status)) {
        const int signal = WTERMSIG(*status);
        const std::string ended = signal == SIGXCPU
                                      ? "does not come to an end"
                                      : fmt::format("crashed ({})", strsignal(signal));
        return Error{
            fmt::format("{}: {} {}, expected a file that it can read", path.string(), name, ended)};
    }
    const int ended = WEXITSTATUS(*status);
    if (ended == kWroteScene)
        return scene_in(file, options);
    if (ended != kWroteError)
        return Error{fmt::format("{}: found a model that takes more memory than is free, or than "
                                 "its files can hold",
                                 path.string())};
    std::ifstream sentence(file.path());
    return Error{std::string(std::istreambuf_iterator<char>(sentence), {})};
}

} // namespace ovc
