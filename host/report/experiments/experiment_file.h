// SPDX-License-Identifier: Apache-2.0
// The JSON file of an experiment, as docs/reference/report.md describes it: what was measured, on
// which machine, and how to measure it again.
#pragma once

#include "host/report/experiments/experiment.h"

#include <filesystem>

namespace ovc {

/// Returns the program's version and a checksum of its file and of the libraries that it loads:
/// "0.1.0, 5c0ffee000112233".
std::string build_text(const std::filesystem::path& program);

/// Returns the run's command as a shell would take it, in a folder called {}.
std::string command_of(const ReportRun& run);

class ExperimentFile {
public:
    /// Reads DIR/NAME.json where it is there. `build`: of the program; runs of another are dropped.
    ExperimentFile(const std::filesystem::path& folder, const Experiment& experiment,
                   const ReportPlan& plan, const std::string& build);

    /// Whether the run is in the file with a result, and where it has a picture, that is there too.
    bool has(const ReportRun& run) const;
    /// Adds what came of a run, in place of what is there of it, and writes the file. one: "key",
    /// "command" and the rest. Error: the file cannot be written.
    Result<Done> keep(Json one);
    /// Drops runs that the plan has no more, puts the others into its order, and says whether none
    /// is missing.
    Result<bool> finish(std::span<const ReportRun> runs);
    /// Returns sentences about runs that failed, or that answered something wrong.
    std::vector<std::string> troubles() const;

    /// Returns DIR/pictures/NAME-KEY.png.
    std::filesystem::path picture_path(const ReportRun& run) const;

private:
    const Json* find(const ReportRun& run) const;
    Result<Done> save() const;

    std::filesystem::path folder_;
    std::string name_;
    Json file_;
};

} // namespace ovc
