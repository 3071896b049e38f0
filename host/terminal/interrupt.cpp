// SPDX-License-Identifier: Apache-2.0
// The handlers of signals. A signal can only reach the program through variables of static
// lifetime.
#include "host/terminal/interrupt.h"

#include "importers/file/output_file.h"

#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <string_view>
#include <utility>

namespace ovc {

static volatile std::sig_atomic_t interrupt_seen = 0;

/// On a terminal, a progress line or ^C may stand before the message, which then begins a new line.
static volatile std::sig_atomic_t on_terminal = 0;

static volatile std::sig_atomic_t silent = 0;

static void say_on(std::string_view text) {
    if (silent)
        return;
    // Nothing can be done about a failed write here.
    [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, text.data(), text.size());
}

static void say(std::string_view line) {
    if (on_terminal)
        say_on("\n");
    say_on(line);
}

static void leave(int) {
    remove_unfinished_output();
    say("overcast: interrupted\n");
    _exit(kExitInterrupted);
}

/// The part of the message that says what the program does; null while no guard lives.
static const char* doing_now = nullptr;

static void handle_interrupts(void (*handler)(int)) {
    std::signal(SIGINT, handler);
    std::signal(SIGTERM, handler);
    if (std::signal(SIGHUP, handler) == SIG_IGN)
        std::signal(SIGHUP, SIG_IGN);
}

static void remember(int) {
    const int errno_before = errno;
    interrupt_seen = 1;
    handle_interrupts(leave);
    say("overcast: interrupted; ");
    say_on(doing_now);
    say_on(" (press again to give up)\n");
    errno = errno_before;
}

static void leave_on_bus_error(int) {
    remove_unfinished_output();
    say("overcast: a file that is in use was cut short, its disk has failed, or there is no room "
        "for shared memory\n");
    _exit(kExitError);
}

void exit_on_bus_error() {
    std::signal(SIGBUS, leave_on_bus_error);
}

void say_nothing_on_interrupt() {
    silent = 1;
}

void exit_on_interrupt() {
    on_terminal = isatty(STDERR_FILENO);
    handle_interrupts(leave);
}

InterruptGuard::InterruptGuard(const char* doing) : outer_(std::exchange(doing_now, doing)) {
    if (outer_)
        return;
    interrupt_seen = 0;
    on_terminal = isatty(STDERR_FILENO);
    handle_interrupts(remember);
}

InterruptGuard::~InterruptGuard() {
    if (!outer_)
        exit_on_interrupt();
    doing_now = outer_;
}

bool is_interrupted() {
    return interrupt_seen != 0;
}

bool InterruptGuard::interrupted() const {
    return is_interrupted();
}

} // namespace ovc
