// SPDX-License-Identifier: Apache-2.0
// The functions that a host hands in for logs, progress and what is saved: while one runs, the
// plugin is in the middle of something, often with locks taken, and answers no call of that thread.
#pragma once

namespace ovc {

/// Whether this thread is inside such a function. Trivial, as all that is thread_local here: when a
/// thread of the host's ends, no code of ours runs.
inline constinit thread_local bool in_host_function = false;

/// Marks the thread while it lives.
class HostFunction {
public:
    HostFunction() { in_host_function = true; }
    ~HostFunction() { in_host_function = before_; }
    HostFunction(const HostFunction&) = delete;

private:
    const bool before_ = in_host_function;
};

} // namespace ovc
