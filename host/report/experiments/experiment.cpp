// SPDX-License-Identifier: Apache-2.0
// The table of experiments.
#include "host/report/experiments/experiment.h"

#include "core/text/suggestion.h"
#include "host/report/experiments/experiment_table.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

namespace ovc {

static const Experiment kExperiments[] = {
    error_experiment(),    tessellation_experiment(), samples_experiment(),
    hard_experiment(),     scale_experiment(),        left_out_experiment(),
    pictures_experiment(), dragons_experiment(),      dragonball_experiment(),
    plants_experiment(),   powerplant_experiment(),   claims_experiment()};

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

} // namespace ovc
