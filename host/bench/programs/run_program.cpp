// SPDX-License-Identifier: Apache-2.0
// Starts a program with posix_spawn and reads its standard error through a pipe.
#include "host/bench/programs/run_program.h"

#include "core/system/stopwatch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cassert>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <sstream>
#include <vector>

extern char** environ;

namespace ovc {

bool is_installed(const std::string& program) {
    const char* path = std::getenv("PATH");
    std::istringstream folders(path ? path : "");
    for (std::string folder; std::getline(folders, folder, ':');)
        if (access((std::filesystem::path(folder) / program).c_str(), X_OK) == 0)
            return true;
    return false;
}

static std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last = "without a word";
    for (std::string line; std::getline(lines, line);)
        if (!line.empty() && line.front() != ' ')
            last = line;
    return last;
}

namespace {

constexpr double kGrace = 10; // seconds between SIGINT and SIGKILL
constexpr int kLookMilliseconds = 50;

struct Child {
    pid_t id = 0;
    int errors = -1; // the reading end of its standard error
};

Result<Child> start(std::span<const std::string> words) {
    assert(!words.empty());
    std::vector<char*> arguments;
    for (const std::string& word : words)
        arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    std::array<int, 2> ends;
    if (pipe2(ends.data(), O_CLOEXEC) != 0)
        return Error{fmt::format("{} cannot be started: {}", words[0], std::strerror(errno))};
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDERR_FILENO);
    Child child;
    const int failed =
        posix_spawnp(&child.id, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    child.errors = ends[0];
    if (!failed)
        return child;
    close(ends[0]);
    return Error{fmt::format("{} cannot be started: {}", words[0], std::strerror(failed))};
}

/// Appends to `text` what the pipe has, waiting for at most kLookMilliseconds. Returns false when
/// the other end is closed.
bool read_some(int pipe, std::string& text) {
    pollfd look{pipe, POLLIN, 0};
    if (poll(&look, 1, kLookMilliseconds) <= 0)
        return true;
    std::array<char, 4096> block;
    const ssize_t size = read(pipe, block.data(), block.size());
    if (size > 0)
        text.append(block.data(), size_t(size));
    return size > 0 || (size < 0 && errno == EINTR);
}

double seconds_of(const timeval& time) {
    return double(time.tv_sec) + 1e-6 * double(time.tv_usec);
}

} // namespace

Result<ProgramEnd> watch_program(std::span<const std::string> words, double limit_seconds,
                                 const std::function<bool()>& stop) {
    const Stopwatch watch;
    const Result<Child> child = start(words);
    if (!child)
        return child.error();
    ProgramEnd end;
    std::string said;
    double asked_at = std::numeric_limits<double>::infinity();
    while (read_some(child->errors, said)) {
        const double now = watch.seconds();
        const bool asked = std::isfinite(asked_at);
        end.stopped = end.stopped || (stop && stop());
        end.too_long = end.too_long || now > limit_seconds;
        if (!asked && (end.stopped || end.too_long)) {
            kill(child->id, SIGINT);
            asked_at = now;
        } else if (now > asked_at + kGrace) {
            kill(child->id, SIGKILL);
        }
    }
    end.stopped = end.stopped || (stop && stop()); // Ctrl-C may have reached the program first
    close(child->errors);
    int status = 0;
    rusage used{};
    while (wait4(child->id, &status, 0, &used) < 0 && errno == EINTR) {
    }
    end.cpu_seconds = seconds_of(used.ru_utime) + seconds_of(used.ru_stime);
    end.seconds = watch.seconds();
    end.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    end.said = last_line(said);
    return end;
}

Result<double> run_program(std::span<const std::string> words) {
    const Result<ProgramEnd> end =
        watch_program(words, std::numeric_limits<double>::infinity(), {});
    if (!end)
        return end.error();
    if (end->exit_code != 0)
        return Error{fmt::format("{} failed: {}", words[0], end->said)};
    return end->seconds;
}

} // namespace ovc
