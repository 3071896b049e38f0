// SPDX-License-Identifier: Apache-2.0
// Runs experiments. Each run is a process of this program, so that one that crashes or takes too
// long does not harm the others.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ovc {

struct RunSurroundings {
    std::string program;          // the file that runs execute, which is this program
    std::string build;            // build_text() of the program
    std::filesystem::path folder; // of the report; it exists
    std::function<bool()> stop;
    /// Is told the progress: "error: dragon, 2 of 9 runs, 3 min left".
    std::function<void(const std::string&)> show;
};

/// Runs what is not done yet of the `chosen` experiment (a name; empty: all), one run after the
/// other, and writes DIR/NAME.json of each. A run that `stop` ends is as if it had not begun. A run
/// beside which other programs used more than a tenth of the cores is repeated, while repeats take
/// no more than a tenth of the time that all is expected to take; the quietest counts. Returns a
/// sentence for each run that failed or answered something wrong. Error: the folder cannot be
/// written, or a process cannot be started.
Result<std::vector<std::string>> run_experiments(std::span<const Experiment> experiments,
                                                 std::string_view chosen, const ReportPlan& plan,
                                                 const RunSurroundings& around);

} // namespace ovc
