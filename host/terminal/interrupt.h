// SPDX-License-Identifier: Apache-2.0
// SIGINT: Ctrl-C ends the program at once with exit code 2, or, while there is something to save,
// asks it to stop.
#pragma once

namespace ovc {

inline constexpr int kExitOk = 0;
inline constexpr int kExitError = 1;
inline constexpr int kExitInterrupted = 2;

/// From now on SIGINT says so and exits with kExitInterrupted. Outputs are written whole, and the
/// one being written is removed, so nothing half done remains.
void exit_on_interrupt();

/// While it lives, the first SIGINT only says so and what is being done about it, and sets
/// interrupted(); a second one exits as above. At most one at a time.
class InterruptGuard {
public:
    /// doing: a literal.
    explicit InterruptGuard(const char* doing = "finishing this batch and saving");
    ~InterruptGuard();
    InterruptGuard(const InterruptGuard&) = delete;
    InterruptGuard& operator=(const InterruptGuard&) = delete;

    bool interrupted() const;
};

} // namespace ovc
