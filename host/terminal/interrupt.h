// SPDX-License-Identifier: Apache-2.0
// Handles SIGINT, SIGTERM and SIGHUP: Ctrl-C, whoever manages a machine's jobs, or a terminal that
// is closed, ends the program at once with exit code 2, or, while there is something to save, asks
// it to stop.
#pragma once

namespace ovc {

inline constexpr int kExitOk = 0;
inline constexpr int kExitError = 1;
inline constexpr int kExitInterrupted = 2;

/// Makes these signals print a message and exit with kExitInterrupted from now on. Outputs are
/// written whole, and the one being written is removed, so nothing half done remains. SIGHUP stays
/// ignored where it is, as under nohup.
void exit_on_interrupt();

/// Lets a mapped file that cannot be read, for it was cut short or its disk has failed, end the
/// program with a sentence and kExitError.
void exit_on_bus_error();

/// Whether the signal has come while a guard lives.
bool is_interrupted();

/// Leaves the messages to another process, which gets the signals too.
void say_nothing_on_interrupt();

/// While a guard lives, the first of them only prints a message with what the program does about
/// it, and sets interrupted(); a second one exits as above. Guards may lie within each other: the
/// inner one says what is done, and all of them are interrupted.
class InterruptGuard {
public:
    /// doing: what the message says that the program does; must outlive the guard.
    explicit InterruptGuard(const char* doing = "finishing this batch and saving");
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool interrupted() const;

private:
    const char* const outer_; // what the guard around this one says; null: there is none
};

} // namespace ovc
