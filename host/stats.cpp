// SPDX-License-Identifier: Apache-2.0
// Statistics, written for programs and for people.
#include "host/stats.h"

#include "host/memory_size.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace ovc {

// Keys stay in the order they are written here, as docs/stats.md lists them.
using Json = nlohmann::ordered_json;

uint64_t host_peak_bytes() {
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return uint64_t(usage.ru_maxrss) * 1024; // Linux counts in KiB
}

static Json times_of(const RenderStats& s) {
    return {{"import", s.seconds_import},         {"level1", s.tracing.seconds_level1},
            {"level2", s.tracing.seconds_level2}, {"trace", s.report.seconds_trace},
            {"kernel", s.tracing.seconds_kernel}, {"shade", s.report.seconds_shade},
            {"output", s.seconds_output},         {"total", s.seconds_total}};
}

std::string stats_json(const RenderStats& s) {
    const ovc_statistics& t = s.tracing;
    const Json document = {
        {"scene", s.scene},
        {"width", s.width},
        {"height", s.height},
        {"complete", s.report.complete},
        {"renderer", s.renderer},
        {"triangles", t.triangles},
        {"dropped", {{"not_finite", t.dropped_not_finite}, {"degenerate", t.dropped_degenerate}}},
        {"twins", t.twins},
        {"leaves", t.leaves},
        {"leaf_references", t.leaf_references},
        {"level2_bytes", t.level2_bytes},
        {"largest_page_bytes", t.largest_page_bytes},
        {"gpu_budget_bytes", t.gpu_budget_bytes},
        {"gpu_peak_bytes", t.gpu_peak_bytes},
        {"host_peak_bytes", host_peak_bytes()},
        {"passes", t.passes},
        {"pages_in", t.pages_in},
        {"bytes_in", t.bytes_in},
        {"rays",
         {{"primary", s.report.rays.primary},
          {"shadow", s.report.rays.shadow},
          {"reflection", s.report.rays.reflection}}},
        {"ray_visits", t.ray_visits},
        {"invalid_rays", t.invalid_rays},
        {"flagged", t.flagged},
        {"retraced", t.retraced},
        {"capped", t.capped},
        {"time", times_of(s)}};
    // A name of a file or a driver need not be UTF-8; what is not is replaced rather than thrown
    // about.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

static std::string gpu_lines(const ovc_statistics& t) {
    std::string text =
        fmt::format("  leaves     {}, {} of level 2, {} the largest page\n", human_count(t.leaves),
                    human_bytes(t.level2_bytes), human_bytes(t.largest_page_bytes));
    text += fmt::format("  GPU        {} at most, of a budget of {}\n",
                        human_bytes(t.gpu_peak_bytes), human_bytes(t.gpu_budget_bytes));
    text += fmt::format("  moved      {} in {} pages, {} passes\n", human_bytes(t.bytes_in),
                        human_count(t.pages_in), human_count(t.passes));
    return text;
}

std::string stats_summary(const RenderStats& s) {
    const ovc_statistics& t = s.tracing;
    const RayCounts& rays = s.report.rays;
    std::string text =
        fmt::format("  scene      {}, {} triangles\n", s.scene, human_count(t.triangles));
    if (const uint64_t dropped = t.dropped_not_finite + t.dropped_degenerate)
        text +=
            fmt::format("  dropped    {} ({} not finite, {} without area)\n", human_count(dropped),
                        human_count(t.dropped_not_finite), human_count(t.dropped_degenerate));
    text += fmt::format("  renderer   {}\n", s.renderer);
    if (t.level2_bytes > 0)
        text += gpu_lines(t);
    text += fmt::format("  rays       {}: {} primary, {} shadow, {} reflection\n",
                        human_count(rays.total()), human_count(rays.primary),
                        human_count(rays.shadow), human_count(rays.reflection));
    if (t.flagged > 0)
        text += fmt::format(
            "  flagged    {} answers, decided in double precision; {} of them traced again\n",
            human_count(t.flagged), human_count(t.retraced));
    text += fmt::format("  host       {} at most\n", human_bytes(host_peak_bytes()));
    text +=
        fmt::format("  seconds    {:.2f}: import {:.2f}, build {:.2f}, trace {:.2f}, shade {:.2f}, "
                    "output {:.2f}\n",
                    s.seconds_total, s.seconds_import, t.seconds_level1 + t.seconds_level2,
                    s.report.seconds_trace, s.report.seconds_shade, s.seconds_output);
    return text;
}

} // namespace ovc
