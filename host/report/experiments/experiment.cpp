// SPDX-License-Identifier: Apache-2.0
// The table of experiments.
#include "host/report/experiments/experiment.h"

#include "core/text/suggestion.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace ovc {

static constexpr Experiment kExperiments[] = {
    {"error", "time against error of answers: every precision, kernel and peer; a budget",
     error_runs},
    {"samples", "the error of a picture against time by samples a pixel, beside other programs",
     samples_runs},
    {"tessellation", "finer and finer triangles against the exact round shapes", tessellation_runs},
    {"stiff", "extreme cases: slivers, seams, far origins, cliffs, ill transforms, stiff optics",
     stiff_runs},
    {"left-out", "what a picture has no need of, switched on and off", left_out_runs},
    {"growth", "cost as rays, triangles, instances, leaves, the budget and threads grow",
     growth_runs},
    {"memory", "budgets of GPU and host memory, and what is read of the disk", memory_runs},
    {"machines", "several processes that share a scene, under mpirun", machines_runs},
    {"programs", "whole programs from file to picture, beside povray and tachyon; the bars",
     programs_runs},
    {"thesis", "the figures of the thesis, in each of its systems and ours", thesis_runs},
    {"pictures", "the scenes of the thesis, and leaves of level 1 in colors", pictures_runs}};

std::span<const Experiment> experiments() {
    return kExperiments;
}

Result<const Experiment*> find_experiment(const std::string& name) {
    std::vector<std::string_view> names;
    for (const Experiment& one : kExperiments) {
        if (one.name == name)
            return &one;
        names.push_back(one.name);
    }
    names.insert(names.end(), {"stability", "leaks", "grid"}); // command_report.cpp has these
    return Error{fmt::format("no report is called '{}'; there are {}{}", name,
                             fmt::join(names, ", "), did_you_mean(name, names))};
}

Words with_words(Words words, const Words& more) {
    words.insert(words.end(), more.begin(), more.end());
    return words;
}

} // namespace ovc
