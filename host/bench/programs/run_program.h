// SPDX-License-Identifier: Apache-2.0
// Runs and times other programs.
#pragma once

#include "core/result.h"

#include <functional>
#include <span>
#include <string>

namespace ovc {

/// Returns whether PATH leads to a program of this name.
bool is_installed(const std::string& program);

/// The end of a program.
struct ProgramEnd {
    double seconds = 0;     // of wall clock
    double cpu_seconds = 0; // of all its threads
    int exit_code = 0;      // -1: a signal ended it
    std::string said;       // its last message, without lines of a scene below it
    bool stopped = false;   // `stop` returned true
    bool too_long = false;  // it ran longer than its limit
};

/// Runs words[0], found by PATH, until it ends; its standard output is dropped. Once `stop` returns
/// true, or after `limit_seconds`, the program gets SIGINT, and SIGKILL 10 s later. words: not
/// empty (asserted). stop: may be empty. Error: the program cannot be started.
Result<ProgramEnd> watch_program(std::span<const std::string> words, double limit_seconds,
                                 const std::function<bool()>& stop);

/// Runs words[0], found by PATH, until it ends, and returns its wall-clock seconds; its output is
/// dropped. words: not empty (asserted). Error: the program cannot be started or does not end with
/// 0, with the last line it wrote to standard error.
Result<double> run_program(std::span<const std::string> words);

} // namespace ovc
