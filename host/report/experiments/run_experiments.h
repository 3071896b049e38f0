// SPDX-License-Identifier: Apache-2.0
// Runs experiments: each run a process of this program, so that one that crashes or takes too long
// costs itself alone.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace ovc {

/// An experiment's raw results, and what went wrong.
struct Outcome {
    const Experiment* experiment = nullptr;
    std::vector<RawResult> results;
    std::vector<std::string> failures; // a sentence for each run without a result
    std::vector<std::string>
        remarks;           // of runs that ended with an error, with a result all the same
    bool complete = false; // every run was done or tried
};

struct RunSurroundings {
    std::string program;          // of the runs: this one
    std::string build;            // build_text() of it
    std::filesystem::path folder; // of the report
    std::function<bool()> stop;
    /// Says what is being done: "error: dragon, 2 of 9 runs, 3 min left".
    std::function<void(const std::string&)> show;
};

/// An outcome for each experiment. Runs what is not done yet of those that are `chosen`, one after
/// the other, and takes what was done before of the others; what `stop` ends is as if it had not
/// begun. chosen: a name; empty: all. Error: the folder cannot be written.
Result<std::vector<Outcome>> run_experiments(std::span<const Experiment> experiments,
                                             std::string_view chosen, const ReportPlan& plan,
                                             const RunSurroundings& around);

} // namespace ovc
