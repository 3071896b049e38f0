// SPDX-License-Identifier: Apache-2.0
// HostFunction: marks a thread while it runs a function that the host has handed in for errors,
// logs, progress or saved bytes. Meanwhile the plugin is in the middle of something, often with
// locks taken, and answers no call of that thread.
#pragma once

#include "plugin/abi/float_mode.h"

namespace ovc {

/// Whether this thread is inside such a function. It is trivial, as all that is thread_local here
/// must be, so that none of our code runs when a thread of the host ends.
inline constinit thread_local bool in_host_function = false;

/// Marks the thread while it lives, and then puts back the floating-point mode that the function
/// may have changed. The loop that called the function would compute on in that mode, on all of its
/// threads.
class HostFunction {
public:
    HostFunction() { in_host_function = true; }
    ~HostFunction() {
        in_host_function = before_;
        set_float_mode(mode_);
    }
    HostFunction(const HostFunction&) = delete;

private:
    const bool before_ = in_host_function;
    const FloatMode mode_ = float_mode();
};

} // namespace ovc
