// SPDX-License-Identifier: Apache-2.0
// Reads the state that belongs to the host of a library: the thread's floating-point mode and
// signal mask, the environment, the handlers of signals, EGL's bindings, and the state and pixels
// of the current GL context.
#pragma once

#include <map>
#include <string>

namespace ovc::test {

/// Holds the bytes of each part by its name.
using HostState = std::map<std::string, std::string>;

HostState host_state();

/// Returns the names of the parts that differ, or an empty string.
std::string difference(const HostState& before, const HostState& after);

} // namespace ovc::test
