// SPDX-License-Identifier: Apache-2.0
// The `overcast` command hands over to a subcommand. It prints an error as one sentence and exits
// with 1.
#include "host/command/command.h"
#include "host/ranks/ranks.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"

#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

/// Of several ranks, one that fails ends all, for the others would wait for it.
static int fail(std::string_view sentence) {
    if (const ovc::Ranks* const ranks = ovc::Ranks::of_run())
        ranks->fail_all(sentence);
    ovc::print_message(sentence);
    return ovc::kExitError;
}

int main(int argc, char** argv) {
    try {
        ovc::exit_on_interrupt();
        ovc::exit_on_bus_error();
        std::signal(SIGXFSZ, SIG_IGN); // write() fails instead where a file may not grow
        const ovc::Result<int> code = ovc::run_command({argv + 1, argv + argc});
        if (!code)
            return fail(code.error().message);
        if (std::fflush(stdout) != 0)
            return fail("cannot write to standard output");
        return *code;
    } catch (const std::bad_alloc&) {
        return fail("out of memory");
    } catch (const std::exception& error) {
        // fmt throws when standard output takes nothing more.
        return fail(std::ferror(stdout) ? "cannot write to standard output" : error.what());
    }
}
