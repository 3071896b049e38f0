// SPDX-License-Identifier: Apache-2.0
// The `overcast` command hands over to a subcommand. It prints an error as one sentence and exits
// with 1.
#include "core/system/caught_error.h"
#include "host/command/command.h"
#include "host/ranks/ranks.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"

#include <fmt/format.h>

#include <fcntl.h>
#include <unistd.h>

#include <csignal>
#include <string>

/// One of several ranks that fails ends all, because the others would wait for it.
static int fail(std::string_view sentence) {
    if (const ovc::Ranks* const ranks = ovc::Ranks::of_run())
        ranks->fail_all(sentence);
    ovc::print_message(sentence);
    return ovc::kExitError;
}

/// Opens those of the standard files that are closed, each so that its use fails as if it still
/// were. Else a file that is opened later would have their number, and messages would go into it.
static void occupy_standard_files() {
    for (const int file : {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO})
        if (fcntl(file, F_GETFD) < 0)
            open("/dev/full", O_WRONLY); // takes the smallest number that is free
}

int main(int argc, char** argv) {
    occupy_standard_files();
    try {
        ovc::exit_on_interrupt();
        ovc::exit_on_bus_error();
        std::signal(SIGXFSZ, SIG_IGN); // write() fails instead where a file may not grow
        const ovc::Result<int> code = ovc::run_command({argv + 1, argv + argc});
        if (!code)
            return fail(code.error().message);
        return *code;
    } catch (...) {
        return fail(ovc::caught_error().message);
    }
}
