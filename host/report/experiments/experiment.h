// SPDX-License-Identifier: Apache-2.0
// An Experiment describes something that the report measures: which commands it runs, which numbers
// it reads from their JSON, and how the page shows them. A new experiment is a file and a row.
#pragma once

#include "core/result.h"
#include "host/report/page/page_model.h"

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

struct ReportPlan {
    bool quick = false;
    std::string mesh;                // the file of the Stanford dragon; empty: generated scenes
    std::vector<std::string> scenes; // replace the scenes of each experiment; empty: its own
    std::string size = {};           // WxH, replaces the --size of every run; empty: its own
};

/// One command of this program. In `words`, "{}" stands for the run's own empty folder.
struct ReportRun {
    std::string key;                // names its file: letters, digits and dashes
    std::vector<std::string> words; // without the program: "bench", "--json", "{}/bench.json"
    std::string result;             // the JSON file that it writes in the folder
    double seconds = 10;            // expected on two cores
    bool may_refuse = false;        // its error is a result as well: {"refused": "..."}
    /// A picture that it writes as well. A .png is kept as it is, an .exr as leaf_patches() of it.
    std::string picture = {};
    std::vector<std::string> variables = {}; // of its environment: "NAME=VALUE"
};

/// The result of a run.
struct RawResult {
    ReportRun run;
    Json result;
    std::string picture = {}; // .png, within the report's folder; empty: none
};

struct Experiment {
    std::string_view name;  // "error"
    std::string_view title; // "Error against run time"
    std::string_view about; // a sentence for --help
    std::vector<ReportRun> (*runs)(const ReportPlan& plan);
    /// Returns every number of the section. results: at least one, in the order of the runs, some
    /// of which may be missing.
    Json (*figures)(std::span<const RawResult> results);
    /// Returns the section's blocks, made from the figures alone.
    std::vector<Block> (*blocks)(const Json& figures);
};

/// Returns all experiments in the order of the page.
std::span<const Experiment> experiments();

/// Returns the experiment of this name. Error: there is none.
Result<const Experiment*> find_experiment(const std::string& name);

} // namespace ovc
