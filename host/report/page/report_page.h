// SPDX-License-Identifier: Apache-2.0
// Does `overcast report -o DIR`: executes runs, computes figures, draws plots and writes the page.
#pragma once

#include "core/result.h"
#include "host/report/experiments/experiment.h"

namespace ovc {

struct ReportJob {
    std::string only; // the name of an experiment; empty: all
    ReportPlan plan;
    std::string folder;
};

/// Writes DIR/index.html, summary.md, NAME.json with the figures of each experiment, plots/, and
/// raw/ with the results of the runs, and returns an exit code. The page has every experiment whose
/// runs are all done, now or earlier, and names the others. Error: something cannot be written or
/// drawn, or a run failed. Where a run or a plot failed, the page is written and says so.
Result<int> make_report_page(const ReportJob& job);

} // namespace ovc
