// SPDX-License-Identifier: Apache-2.0
// Other programs, run and timed.
#pragma once

#include "core/result.h"

#include <span>
#include <string>

namespace ovc {

/// Whether PATH leads to a program of this name.
bool is_installed(const std::string& program);

/// Runs words[0], found by PATH, until it ends; its output goes nowhere. Seconds of wall clock.
/// Error: it cannot be started or does not end with 0, with the last line it wrote to standard
/// error.
Result<double> run_program(std::span<const std::string> words);

} // namespace ovc
