// SPDX-License-Identifier: Apache-2.0
#include "host/arguments/log_arguments.h"

#include "host/arguments/arguments.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

/// In the order of LogLevel.
static constexpr std::string_view kLevels[] = {"error", "warning", "info"};

void LogArguments::add_to(CLI::App& app, bool with_quiet) {
    app.add_option("--log-level", level_,
                   fmt::format("What is said on standard error: no more than errors, warnings too, "
                               "or also what was chosen and why; default: {}",
                               kLevels[size_t(otherwise_)]))
        ->type_name(choice_names(kLevels));
    if (with_quiet)
        app.add_flag("-q,--quiet", quiet_, "Print nothing but warnings and errors");
}

Result<LogLevel> LogArguments::resolve() const {
    if (level_.empty())
        return quiet_ ? std::min(otherwise_, LogLevel::Warning) : otherwise_;
    const Result<size_t> level = parse_choice("--log-level", level_, kLevels);
    if (!level)
        return level.error();
    return LogLevel(*level);
}

} // namespace ovc
