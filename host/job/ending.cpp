// SPDX-License-Identifier: Apache-2.0
// Brings together what all ranks have counted, and says what was written or is left to do.
#include "host/job/ending.h"

#include "core/text/printable.h"
#include "host/film/unfinished.h"
#include "host/output/output.h"
#include "host/ranks/ranks.h"
#include "host/scene/scene_summary.h"
#include "host/terminal/interrupt.h"
#include "host/terminal/message.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstring>
#include <span>
#include <string>
#include <string_view>

namespace ovc {

static void report(const RenderJob& job, const RenderStats& stats,
                   const std::vector<Omission>& omissions) {
    if (const std::string text = omissions_text(omissions); !job.quiet && !text.empty())
        print_message(text);
    if (!job.quiet && stats.frames_there > 0)
        fmt::print("{} frames were there already\n", stats.frames_there);
    if (!job.quiet && !stats.frames.empty() && (stats.report.complete || !job.shots.empty()))
        fmt::print("{}  wrote      {}\n", stats_summary(stats),
                   printable(fmt::format("{}", fmt::join(job.outputs, ", "))));
    if (stats.report.complete)
        return;
    const std::string_view how = stats.report.failed ? "the job has ended" : "interrupted";
    if (job.shots.empty() && stats.report.pixels_done == 0) {
        print_message(fmt::format("{}; no pixel was done, and nothing is saved", how));
        return;
    }
    if (job.shots.empty() && job.render.progressive) {
        print_message(fmt::format("{}; the picture so far is in {}", how,
                                  unfinished_picture(job.outputs[0])));
        return;
    }
    if (job.shots.empty()) {
        print_message(fmt::format("{}; {:.0f} % of the picture is in {}, and the same command with "
                                  "--continue goes on from there",
                                  how,
                                  100.0 * double(stats.report.pixels_done) /
                                      (double(stats.width) * double(stats.height)),
                                  unfinished_picture(job.outputs[0])));
        return;
    }
    const size_t saved = stats.frames_there + stats.frames.size();
    print_message(fmt::format("{}; {} of {} frames are saved, frame {} is the next, and "
                              "the same command with --continue goes on from there",
                              how, saved, job.shots.size(), job.shots[saved].frame));
}

/// Brings what all ranks have counted to the first one.
static Result<Done> gather_ranks(const Ranks& ranks, RenderStats& stats) {
    const RankStats mine{stats.tracing, stats.report.rays, host_peak_bytes(),
                         stats.report.seconds_cpu};
    const auto all = ranks.gather(std::as_bytes(std::span(&mine, 1)), goes_on_always);
    if (!all)
        return all.error();
    RayCounts rays;
    for (uint32_t rank = 0; rank < all->size(); ++rank) {
        RankStats& of_rank = stats.ranks.emplace_back();
        std::memcpy(&of_rank, (*all)[rank].data(), sizeof(of_rank));
        stats.rank_names.push_back(ranks.name_of(rank));
        rays += of_rank.rays;
    }
    stats.report.rays = rays;
    return Done{};
}

/// Ends the job, once the first rank has saved what there is.
[[noreturn]] static void end_all_ranks(const Ranks& ranks, int code) {
    if (!ranks.is_first())
        (void)ranks.spread({}, goes_on_always); // which the first one never does
    ranks.end_all(code);
}

Result<int> tell(const RenderJob& job, const Stopwatch& total,
                 const std::vector<Omission>& omissions, RenderStats& stats) {
    const Ranks* const ranks = job.render.ranks;
    if (ranks && stats.report.complete)
        if (const Result<Done> done = gather_ranks(*ranks, stats); !done)
            return done.error();
    stats.seconds_total = total.seconds();
    if (!job.stats.empty() && is_first_rank(job))
        if (const Result<Done> done = save_text(stats_json(stats), job.stats); !done)
            return done.error();
    if (is_first_rank(job))
        report(job, stats, omissions);
    const int code = stats.report.complete ? kExitOk
                     : stats.report.failed ? kExitError
                                           : kExitInterrupted;
    if (ranks && code != kExitOk)
        end_all_ranks(*ranks, code);
    return code;
}

} // namespace ovc
