// SPDX-License-Identifier: Apache-2.0
// An Experiment describes something that the report measures: which commands it runs. What they
// print as JSON is kept as it is; tools/report makes figures of it.
#pragma once

#include "core/result.h"

#include <nlohmann/json.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace ovc {

using Json = nlohmann::ordered_json;

struct ReportPlan {
    bool quick = false;
    std::string data;                // a folder of real files; empty: generated scenes alone
    std::string mesh = {};           // its scan of the Stanford dragon; empty: generated scenes
    std::vector<std::string> scenes; // replace the scenes of each experiment; empty: its own
    std::string size = {};           // WxH, replaces the --size of every run; empty: its own
};

using Words = std::vector<std::string>;

/// One command of this program. In words, "{}" stands for the run's own empty folder.
struct ReportRun {
    std::string key;          // unlike others of the experiment: letters, digits, dashes
    Words words;              // without the program: "bench", "--json", "{}/bench.json"
    std::string result;       // the JSON file that it writes in the folder
    double seconds = 5;       // expected on two cores
    Words before = {};        // a command of this program that runs first; empty: none
    uint32_t ranks = 0;       // under mpirun with so many processes; 0: without it
    Words variables = {};     // of its environment: "NAME=VALUE"
    std::string picture = {}; // a picture that it writes as well: .png, or .exr with leaf numbers
    bool may_refuse = false;  // its error is a result as well: {"refused": "..."}
    bool judges = false;      // exit code 1 is a verdict, which its result explains
    bool timed = true;        // whether other programs on the machine disturb its result
};

struct Experiment {
    std::string_view name;  // "error"
    std::string_view about; // a sentence for --help
    std::vector<ReportRun> (*runs)(const ReportPlan& plan);
};

/// Returns all experiments in the order in which they run.
std::span<const Experiment> experiments();

/// Returns the experiment of this name. Error: there is none.
Result<const Experiment*> find_experiment(const std::string& name);

/// Returns the words and then more of them.
Words with_words(Words words, const Words& more);

// The runs of each experiment.
std::vector<ReportRun> error_runs(const ReportPlan& plan);
std::vector<ReportRun> samples_runs(const ReportPlan& plan);
std::vector<ReportRun> tessellation_runs(const ReportPlan& plan);
std::vector<ReportRun> stiff_runs(const ReportPlan& plan);
std::vector<ReportRun> left_out_runs(const ReportPlan& plan);
std::vector<ReportRun> growth_runs(const ReportPlan& plan);
std::vector<ReportRun> memory_runs(const ReportPlan& plan);
std::vector<ReportRun> machines_runs(const ReportPlan& plan);
std::vector<ReportRun> programs_runs(const ReportPlan& plan);
std::vector<ReportRun> thesis_runs(const ReportPlan& plan);
std::vector<ReportRun> pictures_runs(const ReportPlan& plan);

} // namespace ovc
