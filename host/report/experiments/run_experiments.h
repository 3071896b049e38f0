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

/// An experiment's raw results and errors.
struct Outcome {
    const Experiment* experiment = nullptr;
    std::vector<RawResult> results;
    std::vector<std::string> failures; // a sentence for each run without a result
    std::vector<std::string> remarks;  // errors of runs that wrote a result all the same
    bool complete = false;             // every run was done or tried
};

struct RunSurroundings {
    std::string program;          // the file that runs execute, which is this program
    std::string build;            // build_text() of the program
    std::filesystem::path folder; // of the report
    std::function<bool()> stop;
    /// Is told the progress: "error: dragon, 2 of 9 runs, 3 min left".
    std::function<void(const std::string&)> show;
};

/// Returns an outcome for each experiment. Runs of the `chosen` experiments that are not done yet
/// are executed, one after the other; other experiments have the results of earlier calls. A run
/// that `stop` ends is as if it had not begun. chosen: a name; empty: all. Error: the folder cannot
/// be written, or a process cannot be started.
Result<std::vector<Outcome>> run_experiments(std::span<const Experiment> experiments,
                                             std::string_view chosen, const ReportPlan& plan,
                                             const RunSurroundings& around);

} // namespace ovc
