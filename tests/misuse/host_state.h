// SPDX-License-Identifier: Apache-2.0
// What belongs to the host of a library, as of now: the thread's floating-point mode and signal
// mask, the environment, the handlers of signals, EGL's bindings, and the state and pixels of the
// GL context that is current.
#pragma once

#include <map>
#include <string>

namespace ovc::test {

/// Each part by its name, as bytes.
using HostState = std::map<std::string, std::string>;

HostState host_state();

/// The names of the parts that differ; empty: none do.
std::string difference(const HostState& before, const HostState& after);

} // namespace ovc::test
