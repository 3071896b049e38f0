// SPDX-License-Identifier: Apache-2.0
// The subcommands. Each parses its own arguments and runs; the result is an exit code, or the
// sentence to fail with.
#pragma once

#include "core/result.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

using Arguments = std::vector<std::string>;

Result<int> run_render(const Arguments& arguments);
Result<int> run_info(const Arguments& arguments);
Result<int> run_trace(const Arguments& arguments);
Result<int> run_convert(const Arguments& arguments);
Result<int> run_devices(const Arguments& arguments);
Result<int> run_scenes(const Arguments& arguments);
Result<int> run_report(const Arguments& arguments);
Result<int> run_bench(const Arguments& arguments);

struct Command {
    std::string_view name;
    std::string_view summary;
    Result<int> (*run)(const Arguments& arguments);
};

/// In the order of the help.
std::span<const Command> commands();

/// The whole program but for exceptions: arguments are those after the program's name.
Result<int> run_command(const Arguments& arguments);

} // namespace ovc
