// SPDX-License-Identifier: Apache-2.0
// Experiment: something that the report measures, as a pure description: which commands it runs,
// what it reads out of their JSON, and how that is shown. A new experiment is a file and a row.
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
    std::vector<std::string> scenes; // instead of the scenes of an experiment; empty: its own
};

/// One command of this program. In `words`, "{}" is an empty folder that is its own.
struct ReportRun {
    std::string key;                // names its file: letters, digits and dashes
    std::vector<std::string> words; // without the program: "bench", "--json", "{}/bench.json"
    std::string result;             // the JSON file it leaves in the folder
    double seconds = 10;            // about so long on two cores
    bool may_refuse = false;        // its one sentence is a result as well: {"refused": "..."}
    /// A picture it leaves as well, which is kept: .png; or .exr, of which leaf_patches() is kept.
    std::string picture = {};
    std::vector<std::string> variables = {}; // of its environment: "NAME=VALUE"
};

/// What a run left behind.
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
    /// Every number of the section; results in the order of the runs, some of which may be missing.
    Json (*figures)(std::span<const RawResult> results);
    /// From figures alone.
    std::vector<Block> (*blocks)(const Json& figures);
};

/// In the order of the page.
std::span<const Experiment> experiments();

/// Error: none has this name.
Result<const Experiment*> find_experiment(const std::string& name);

} // namespace ovc
