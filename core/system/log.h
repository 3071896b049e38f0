// SPDX-License-Identifier: Apache-2.0
// Log: where messages for a person go. It is a value that is handed down, never a global.
#pragma once

#include <functional>
#include <string>

namespace ovc {

/// Error: the call failed. Warning: the result stands, but something was left out. Info: what was
/// chosen and why.
enum class LogLevel { Error = 0, Warning = 1, Info = 2 };

/// Receives one sentence without a line end. It may be empty, and then nothing is said.
using LogSink = std::function<void(LogLevel, const std::string&)>;

inline void say(const LogSink& log, LogLevel level, const std::string& message) {
    if (log)
        log(level, message);
}

} // namespace ovc
