// SPDX-License-Identifier: Apache-2.0
// posix_spawn, and a pipe for what goes wrong.
#include "host/bench/run_program.h"

#include "core/stopwatch.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
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

/// All that comes until the other end is closed.
static std::string read_all(int pipe) {
    std::string text;
    std::array<char, 4096> block;
    for (ssize_t size; (size = read(pipe, block.data(), block.size())) > 0;)
        text.append(block.data(), size_t(size));
    return text;
}

static std::string last_line(const std::string& text) {
    std::istringstream lines(text);
    std::string last = "without a word";
    for (std::string line; std::getline(lines, line);)
        if (!line.empty())
            last = line;
    return last;
}

Result<double> run_program(std::span<const std::string> words) {
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
    const Stopwatch watch;
    pid_t child = 0;
    const int failed =
        posix_spawnp(&child, words[0].c_str(), &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    const std::string said = failed ? "" : read_all(ends[0]);
    close(ends[0]);
    if (failed)
        return Error{fmt::format("{} cannot be started: {}", words[0], std::strerror(failed))};
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    const double seconds = watch.seconds();
    if (!WIFEXITED(status) || WEXITSTATUS(status) != 0)
        return Error{fmt::format("{} failed: {}", words[0], last_line(said))};
    return seconds;
}

} // namespace ovc
