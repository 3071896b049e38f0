// SPDX-License-Identifier: Apache-2.0
// The two signal handlers. A signal has no other way to reach the program than a flag of static
// lifetime.
#include "host/interrupt.h"

#include <unistd.h>

#include <csignal>
#include <string_view>

namespace ovc {

static volatile std::sig_atomic_t interrupt_seen = 0;

static void leave(int) {
    static constexpr std::string_view kMessage = "\novercast: interrupted\n";
    // Nothing can be done about a failed write here.
    [[maybe_unused]] const auto written = write(STDERR_FILENO, kMessage.data(), kMessage.size());
    _exit(kExitInterrupted);
}

static void remember(int) {
    interrupt_seen = 1;
    std::signal(SIGINT, leave);
}

void exit_on_interrupt() {
    std::signal(SIGINT, leave);
}

InterruptGuard::InterruptGuard() {
    interrupt_seen = 0;
    std::signal(SIGINT, remember);
}

InterruptGuard::~InterruptGuard() {
    exit_on_interrupt();
}

bool InterruptGuard::interrupted() const {
    return interrupt_seen != 0;
}

} // namespace ovc
