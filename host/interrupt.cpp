// SPDX-License-Identifier: Apache-2.0
// The two signal handlers. A signal has no other way to reach the program than a flag of static
// lifetime.
#include "host/interrupt.h"

#include "importers/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>

namespace ovc {

static volatile std::sig_atomic_t interrupt_seen = 0;

/// Whether a progress line or the terminal's ^C may stand before the message.
static volatile std::sig_atomic_t on_terminal = 0;

static void say(std::string_view line) {
    // Nothing can be done about a failed write here.
    [[maybe_unused]] ssize_t written = 0;
    if (on_terminal)
        written = write(STDERR_FILENO, "\n", 1);
    written = write(STDERR_FILENO, line.data(), line.size());
}

static void leave(int) {
    remove_unfinished_output();
    say("overcast: interrupted\n");
    _exit(kExitInterrupted);
}

static void remember(int) {
    const int errno_before = errno;
    interrupt_seen = 1;
    std::signal(SIGINT, leave);
    say("overcast: interrupted; finishing this batch and saving (press again to give up)\n");
    errno = errno_before;
}

void exit_on_interrupt() {
    on_terminal = isatty(STDERR_FILENO);
    std::signal(SIGINT, leave);
}

InterruptGuard::InterruptGuard() {
    interrupt_seen = 0;
    on_terminal = isatty(STDERR_FILENO);
    std::signal(SIGINT, remember);
}

InterruptGuard::~InterruptGuard() {
    exit_on_interrupt();
}

bool InterruptGuard::interrupted() const {
    return interrupt_seen != 0;
}

} // namespace ovc
