// SPDX-License-Identifier: Apache-2.0
// --log-level and --quiet: how much a command says on standard error.
#pragma once

#include "core/result.h"
#include "core/system/log.h"

#include <string>

namespace CLI {
class App;
}

namespace ovc {

class LogArguments {
public:
    /// otherwise: the level where neither option is given.
    explicit LogArguments(LogLevel otherwise = LogLevel::Warning) : otherwise_(otherwise) {}

    /// Adds --log-level, and with_quiet also --quiet.
    void add_to(CLI::App& app, bool with_quiet = false);

    bool quiet() const { return quiet_; }
    /// Returns the level to log at; --log-level overrides --quiet. Error: no level of that name.
    Result<LogLevel> resolve() const;

private:
    LogLevel otherwise_;
    std::string level_;
    bool quiet_ = false;
};

} // namespace ovc
