// SPDX-License-Identifier: Apache-2.0
// `overcast report -o DIR`: runs, figures, plots, page.
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
/// raw/ with what the runs left. The page has every experiment whose runs are all there, also from
/// before, and names the others. Returns an exit code. Error: something cannot be written or drawn,
/// or a run failed; the page, which says so, is there even then.
Result<int> make_report_page(const ReportJob& job);

} // namespace ovc
