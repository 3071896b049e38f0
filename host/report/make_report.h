// SPDX-License-Identifier: Apache-2.0
// Makes the report as a whole: runs experiments, and has tools/report write the page.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

#include <string>

namespace ovc {

struct ReportJob {
    std::string folder;
    std::string only; // an experiment; empty: all
    ReportPlan plan;
    std::string compare; // the folder of another report; empty: none
    std::string kit;     // the JSON that a GPU kit brought back; empty: none
};

/// Runs what is not done yet, writes the JSON of each experiment, then the page with Python. Prints
/// the page's path. Returns the exit code. Error: a run failed, something was answered wrong, or
/// the page could not be written; the JSON is there all the same.
Result<int> make_report_page(const ReportJob& job);

} // namespace ovc
