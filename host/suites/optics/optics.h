// SPDX-License-Identifier: Apache-2.0
// Stiff optics measures spawned rays, refraction and deep mirrors through the host's own shading,
// as a table of the stability report. A new case is one row.
#pragma once

#include "core/result.h"
#include "core/system/log.h"
#include "host/backend/backend.h"

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace ovc {

struct OpticsOptions {
    BackendOptions backend;
    uint64_t times = 1;          // multiplies the short form's rays
    uint32_t shapes = 1000;      // for each scale of spawned rays
    std::function<bool()> go_on; // called before each case; false: stop. Empty: go on
};

struct OpticsScore {
    uint64_t rays = 0;
    uint64_t wrong = 0; // as OpticsCase::wrong says
    uint64_t leaks = 0; // rays within a closed shape that never meet it
    double error = 0;   // largest; relative, or of a color
};

struct OpticsCase {
    std::string name;
    std::string wrong; // says in words which answers count as wrong
    std::function<Result<OpticsScore>(const OpticsOptions&, const LogSink&)> run;
};

struct OpticsResult {
    std::string name, counted;
    OpticsScore score;
};

/// Returns all cases in the order of the report.
std::vector<OpticsCase> optics_cases();

/// Runs the cases in turn, until go_on() returns false. seen: called after each case. Error: the
/// plugin failed.
Result<std::vector<OpticsResult>> run_optics(std::span<const OpticsCase> cases,
                                             const OpticsOptions& options, const LogSink& log,
                                             const std::function<void(const OpticsResult&)>& seen);

/// Returns the legend of the columns and the table.
std::string optics_markdown(std::span<const OpticsResult> results);

} // namespace ovc
