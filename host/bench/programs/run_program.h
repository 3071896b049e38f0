// SPDX-License-Identifier: Apache-2.0
// Other programs, run and timed.
#pragma once

#include "core/result.h"

#include <functional>
#include <span>
#include <string>

namespace ovc {

/// Whether PATH leads to a program of this name.
bool is_installed(const std::string& program);

/// How a program came to its end.
struct ProgramEnd {
    double seconds = 0;     // of wall clock
    double cpu_seconds = 0; // of all its threads
    int exit_code = 0;      // -1: a signal ended it
    std::string said;       // the last line it wrote to standard error
    bool stopped = false;
    bool too_long = false;
};

/// Runs words[0], found by PATH, until it ends; its other output goes nowhere. Once `stop` says so,
/// or after `limit_seconds`, it is asked to end by SIGINT, and ended 10 s later. Error: it cannot
/// be started.
Result<ProgramEnd> watch_program(std::span<const std::string> words, double limit_seconds,
                                 const std::function<bool()>& stop);

/// Runs words[0], found by PATH, until it ends; its output goes nowhere. Seconds of wall clock.
/// Error: it cannot be started or does not end with 0, with the last line it wrote to standard
/// error.
Result<double> run_program(std::span<const std::string> words);

} // namespace ovc
