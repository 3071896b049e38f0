// SPDX-License-Identifier: Apache-2.0
// Statistics, written for programs and for people.
#include "host/output/stats.h"

#include "core/text/printable.h"
#include "host/arguments/memory_size.h"
#include "host/terminal/process_cost.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ovc {

// Keys stay in the order they are written here, as docs/reference/stats.md lists them.
using Json = nlohmann::ordered_json;

uint64_t host_peak_bytes() {
    // getrusage() would count what the program that started this one had.
    return resident_bytes("VmHWM");
}

ovc_statistics counted_between(const ovc_statistics& before, const ovc_statistics& after) {
    ovc_statistics counted = after;
    for (const auto count :
         {&ovc_statistics::passes, &ovc_statistics::pages_in, &ovc_statistics::bytes_in,
          &ovc_statistics::nearest_rays, &ovc_statistics::occlusion_rays,
          &ovc_statistics::invalid_rays, &ovc_statistics::ray_visits, &ovc_statistics::flagged,
          &ovc_statistics::retraced, &ovc_statistics::queues, &ovc_statistics::queued_rays,
          &ovc_statistics::stragglers})
        counted.*count -= before.*count;
    counted.seconds_trace -= before.seconds_trace;
    counted.seconds_pass -= before.seconds_pass;
    counted.seconds_kernel -= before.seconds_kernel;
    return counted;
}

void RenderStats::add(const FrameStats& frame) {
    report += frame.report;
    seconds_output += frame.seconds_output;
    frames.push_back(frame);
}

static Json rays_of(const RayCounts& rays) {
    return {{"primary", rays.primary},
            {"shadow", rays.shadow},
            {"reflection", rays.reflection},
            {"refraction", rays.refraction},
            {"bounce", rays.bounce}};
}

static Json queues_of(const ovc_statistics& t) {
    return {{"count", t.queues},
            {"rays", t.queued_rays},
            {"longest", t.longest_queue},
            {"stragglers", t.stragglers}};
}

static Json active_of(const std::optional<ovc_active>& active) {
    if (!active)
        return nullptr;
    return {{"pages", active->pages},
            {"bytes", active->bytes},
            {"new_pages", active->new_pages},
            {"new_bytes", active->new_bytes}};
}

static Json frame_of(const FrameStats& f) {
    return {{"frame", f.frame},
            {"complete", f.report.complete},
            {"passes", f.tracing.passes},
            {"pages_in", f.tracing.pages_in},
            {"bytes_in", f.tracing.bytes_in},
            {"rays", rays_of(f.report.rays)},
            {"ray_visits", f.tracing.ray_visits},
            {"flagged", f.tracing.flagged},
            {"retraced", f.tracing.retraced},
            {"queues", queues_of(f.tracing)},
            {"active", active_of(f.active)},
            {"gpu_peak_bytes", f.tracing.gpu_peak_bytes},
            {"host_peak_bytes", f.host_peak_bytes},
            {"time",
             {{"trace", f.report.seconds_trace},
              {"pass", f.tracing.seconds_pass},
              {"kernel", f.tracing.seconds_kernel},
              {"shade", f.report.seconds_shade},
              {"render", f.report.seconds},
              {"cpu", f.report.seconds_cpu},
              {"output", f.seconds_output},
              {"total", f.seconds}}}};
}

static Json frames_of(const RenderStats& s) {
    Json frames = Json::array();
    for (const FrameStats& frame : s.frames)
        frames.push_back(frame_of(frame));
    return frames;
}

std::string frame_json(const FrameStats& frame) {
    return frame_of(frame).dump();
}

static Json left_out_of(const RenderStats& s) {
    Json list = Json::array();
    for (const LeftOut& item : s.left_out)
        list.push_back({{"what", item.what}, {"bytes", item.bytes}});
    return list;
}

static Json times_of(const RenderStats& s) {
    return {{"import", s.seconds_import},
            {"level1", s.tracing.seconds_level1},
            {"level2", s.tracing.seconds_level2},
            {"trace", s.report.seconds_trace},
            {"pass", s.tracing.seconds_pass},
            {"kernel", s.tracing.seconds_kernel},
            {"shade", s.report.seconds_shade},
            {"render", s.report.seconds},
            {"cpu", s.report.seconds_cpu},
            {"output", s.seconds_output},
            {"total", s.seconds_total}};
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
        {"unique_triangles", t.unique_triangles},
        {"instances", t.instances},
        {"top_level_bytes", t.top_level_bytes},
        {"gpu_budget_bytes", t.gpu_budget_bytes},
        {"gpu_peak_bytes", t.gpu_peak_bytes},
        {"host_peak_bytes", host_peak_bytes()},
        {"passes", t.passes},
        {"pages_in", t.pages_in},
        {"bytes_in", t.bytes_in},
        {"rays", rays_of(s.report.rays)},
        {"ray_visits", t.ray_visits},
        {"invalid_rays", t.invalid_rays},
        {"flagged", t.flagged},
        {"retraced", t.retraced},
        {"capped", t.capped},
        {"queues", queues_of(t)},
        {"left_out", left_out_of(s)},
        {"from_cache", {{"scene", s.scene_from_cache}, {"levels", t.from_saved != 0}}},
        {"time", times_of(s)},
        {"frames", frames_of(s)}};
    // A name of a file or a driver need not be UTF-8; what is not is replaced rather than
    // thrown about.
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string frame_summary(const FrameStats& f) {
    std::string text = fmt::format("frame {:<4} {:7.2f} s, {} rays", f.frame, f.seconds,
                                   human_count(f.report.rays.total()));
    if (f.tracing.level2_bytes > 0)
        text += fmt::format(", {} passes, {} moved in {} pages", human_count(f.tracing.passes),
                            human_bytes(f.tracing.bytes_in), human_count(f.tracing.pages_in));
    return text;
}

static std::string gpu_lines(const ovc_statistics& t) {
    std::string text =
        fmt::format("  leaves     {}, {} of level 2, {} the largest page\n", human_count(t.leaves),
                    human_bytes(t.level2_bytes), human_bytes(t.largest_page_bytes));
    if (t.instances > 0)
        text += fmt::format("  instances  {} share pages of {} triangles, {} to find them by\n",
                            human_count(t.instances), human_count(t.unique_triangles),
                            human_bytes(t.top_level_bytes));
    text += fmt::format("  GPU        {} at most, of a budget of {}\n",
                        human_bytes(t.gpu_peak_bytes), human_bytes(t.gpu_budget_bytes));
    text += fmt::format("  moved      {} in {} pages, {} passes\n", human_bytes(t.bytes_in),
                        human_count(t.pages_in), human_count(t.passes));
    return text;
}

std::string stats_summary(const RenderStats& s) {
    const ovc_statistics& t = s.tracing;
    const RayCounts& rays = s.report.rays;
    std::string text = fmt::format("  scene      {}, {} triangles\n", printable(s.scene),
                                   human_count(t.triangles));
    if (const uint64_t dropped = t.dropped_not_finite + t.dropped_degenerate)
        text +=
            fmt::format("  dropped    {} ({} not finite, {} without area)\n", human_count(dropped),
                        human_count(t.dropped_not_finite), human_count(t.dropped_degenerate));
    text += fmt::format("  renderer   {}\n", s.renderer);
    if (t.level2_bytes > 0)
        text += gpu_lines(t);
    text +=
        fmt::format("  rays       {}: {} primary, {} shadow, {} reflection, {} refraction\n",
                    human_count(rays.total()), human_count(rays.primary), human_count(rays.shadow),
                    human_count(rays.reflection), human_count(rays.refraction));
    if (rays.bounce > 0)
        text.insert(text.size() - 1, fmt::format(", {} bounces", human_count(rays.bounce)));
    if (t.flagged > 0)
        text += fmt::format(
            "  flagged    {} answers, decided in double precision; {} of them traced again\n",
            human_count(t.flagged), human_count(t.retraced));
    if (!s.left_out.empty())
        text += fmt::format("  left out   {}\n", left_out_text(s.left_out));
    text += fmt::format("  host       {} at most\n", human_bytes(host_peak_bytes()));
    text +=
        fmt::format("  seconds    {:.2f}: import {:.2f}, build {:.2f}, trace {:.2f}, shade {:.2f}, "
                    "output {:.2f}\n",
                    s.seconds_total, s.seconds_import, t.seconds_level1 + t.seconds_level2,
                    s.report.seconds_trace, s.report.seconds_shade, s.seconds_output);
    return text;
}

} // namespace ovc
