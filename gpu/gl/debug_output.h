// SPDX-License-Identifier: Apache-2.0
// Sends the messages of the driver (KHR_debug) to the log.
#pragma once

#include "core/system/log.h"

#include <memory>

namespace ovc {

/// While this lives, errors and warnings of the current context go to the log; in debug builds they
/// come synchronously, and an error stops the program where it happened.
class DebugOutput {
public:
    explicit DebugOutput(LogSink log);
    ~DebugOutput();
    DebugOutput(DebugOutput&&) = default;
    DebugOutput& operator=(DebugOutput&&) = default;

private:
    std::unique_ptr<LogSink> log_; // on the heap, because the driver keeps its address
};

} // namespace ovc
