// SPDX-License-Identifier: Apache-2.0
// Runs a command as a user would, and keeps its output.
#pragma once

#include <array>
#include <cstdio>
#include <string>

#include <sys/wait.h>

namespace ovc::test {

struct CommandResult {
    int exit_code = -1; // stays -1 if a signal ended the command
    std::string output; // standard output and standard error
};

/// Runs the command through /bin/sh. Output that it does not redirect is captured.
inline CommandResult run_shell(const std::string& command) {
    CommandResult result;
    FILE* pipe = popen(("{ " + command + "; } 2>&1").c_str(), "r");
    if (!pipe)
        return result;
    std::array<char, 4096> block;
    while (const size_t n = fread(block.data(), 1, block.size(), pipe))
        result.output.append(block.data(), n);
    const int status = pclose(pipe);
    result.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : -1;
    return result;
}

/// Removes warnings from a command's output, and the remark that it takes the software renderer.
inline std::string without_remarks(std::string text) {
    for (const char* remark : {"overcast: warning:", "overcast: no GPU found"})
        for (size_t at; (at = text.find(remark)) != std::string::npos;)
            text.erase(at, text.find('\n', at) + 1 - at);
    return text;
}

} // namespace ovc::test
