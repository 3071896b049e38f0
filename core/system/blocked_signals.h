// SPDX-License-Identifier: Apache-2.0
// BlockedSignals: threads of the library leave the process's signals to threads of the host.
#pragma once

#include <signal.h>

namespace ovc {

/// While it lives, threads that this thread starts are born with signals blocked. A host may wait
/// for a signal (sigwait, signalfd), which it blocks on its own threads for that: on a thread where
/// it is open, it would end the process. Signals of a thread's own faults stay open for the host's
/// handlers, and SIGPROF for its profiler.
class BlockedSignals {
public:
    BlockedSignals() {
        sigset_t blocked;
        sigfillset(&blocked);
        for (const int open : {SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGPROF, SIGSEGV, SIGSYS, SIGTRAP})
            sigdelset(&blocked, open);
        pthread_sigmask(SIG_BLOCK, &blocked, &before_);
    }
    ~BlockedSignals() { pthread_sigmask(SIG_SETMASK, &before_, nullptr); }
    BlockedSignals(const BlockedSignals&) = delete;
    BlockedSignals& operator=(const BlockedSignals&) = delete;

private:
    sigset_t before_;
};

} // namespace ovc
