// SPDX-License-Identifier: Apache-2.0
// The end of `overcast render`: its statistics, and what the user hears of it.
#pragma once

#include "core/result.h"
#include "core/scene.h"
#include "core/system/stopwatch.h"
#include "host/job/render_job.h"
#include "host/output/stats.h"
#include "host/ranks/ranks.h"

#include <vector>

namespace ovc {

/// Returns whether this process is the one, or the first of several, which writes the outputs.
inline bool is_first_rank(const RenderJob& job) {
    return !job.render.ranks || job.render.ranks->is_first();
}

/// Tells the user of the run, and ends it where there are several ranks and it is not complete.
/// total: since its start. stats: gets what all ranks have counted, and the time. Returns the exit
/// code.
Result<int> tell(const RenderJob& job, const Stopwatch& total,
                 const std::vector<Omission>& omissions, RenderStats& stats);

} // namespace ovc
