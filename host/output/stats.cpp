// SPDX-License-Identifier: Apache-2.0
// Statistics, written for programs and for people.
#include "host/output/stats.h"

#include "core/text/printable.h"
#include "host/arguments/memory_size.h"
#include "host/terminal/process_cost.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstring>
#include <string_view>
#include <utility>

namespace ovc {

// Keys stay in the order they are written here, as docs/reference/stats.md lists them.
using Json = nlohmann::ordered_json;

uint64_t host_peak_bytes() {
    // getrusage() would count what the program that started this one had.
    return resident_bytes("VmHWM");
}

/// Calls visit(name, field, counts up) for each field of ovc_statistics.
template <class Visit>
static void for_each_statistic(Visit&& visit) {
#define OVC_STATISTIC(name, counts_up) visit(#name, &ovc_statistics::name, counts_up);
#include "statistics_fields.inc"
#undef OVC_STATISTIC
}

#define OVC_STATISTIC(name, counts_up) +1
static_assert(sizeof(ovc_statistics) == 8 * (1
#include "statistics_fields.inc"
                                             ),
              "cmake/statistics.cmake has overlooked a field of plugin/overcast.h");
#undef OVC_STATISTIC

/// Where a field stands in the document: under its own name, except for those that belong together.
static Json::json_pointer place_of(std::string_view field) {
    static constexpr std::pair<std::string_view, const char*> kPlaces[] = {
        {"queues", "/queues/count"},
        {"queued_rays", "/queues/rays"},
        {"longest_queue", "/queues/longest"},
        {"stragglers", "/queues/stragglers"},
        {"from_saved", "/from_cache/levels"}};
    for (const auto& [name, place] : kPlaces)
        if (field == name)
            return Json::json_pointer(place);
    for (const auto& [prefix, group] : {std::pair("seconds_", "/time/"), {"dropped_", "/dropped/"}})
        if (field.starts_with(prefix))
            return Json::json_pointer(group + std::string(field.substr(strlen(prefix))));
    return Json::json_pointer("/" + std::string(field));
}

ovc_statistics counted_between(const ovc_statistics& before, const ovc_statistics& after) {
    ovc_statistics counted = after;
    for_each_statistic([&](const char*, auto field, bool counts_up) {
        if (counts_up)
            counted.*field -= before.*field;
    });
    return counted;
}

ovc_statistics counted_besides(const ovc_statistics& earlier, const ovc_statistics& now) {
    ovc_statistics counted = now;
    for_each_statistic([&](const char*, auto field, bool counts_up) {
        if (counts_up)
            counted.*field += earlier.*field;
    });
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

static Json active_of(const std::optional<ovc_active>& active) {
    if (!active)
        return nullptr;
    return {{"pages", active->pages},
            {"bytes", active->bytes},
            {"new_pages", active->new_pages},
            {"new_bytes", active->new_bytes}};
}

/// The times of the renderer; its `trace` stands for that of the library, which other backends than
/// the plugin do not tell.
static void add_times(Json& time, const RenderReport& report) {
    time["trace"] = report.seconds_trace;
    time["shade"] = report.seconds_shade;
    time["render"] = report.seconds;
    time["cpu"] = report.seconds_cpu;
}

static Json frame_of(const FrameStats& f) {
    Json frame = {{"frame", f.frame}, {"complete", f.report.complete}};
    for_each_statistic([&](const char* name, auto field, bool counts_up) {
        if (counts_up)
            frame[place_of(name)] = f.tracing.*field;
    });
    frame["queues"]["longest"] = f.tracing.longest_queue;
    frame["rays"] = rays_of(f.report.rays);
    frame["active"] = active_of(f.active);
    if (const std::optional<Sampled>& sampled = f.report.sampled)
        frame["sampled"] = {{"min", sampled->min},
                            {"mean", sampled->mean},
                            {"max", sampled->max},
                            {"noise", sampled->noise}};
    frame["gpu_peak_bytes"] = f.tracing.gpu_peak_bytes;
    frame["host_peak_bytes"] = f.host_peak_bytes;
    add_times(frame["time"], f.report);
    frame["time"]["scene"] = f.seconds_scene;
    frame["time"]["output"] = f.seconds_output;
    frame["time"]["total"] = f.seconds;
    return frame;
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

/// Returns how much more than the mean the busiest rank had to do; 1 where all had the same.
static double imbalance(const RenderStats& s) {
    double sum = 0, max = 0;
    for (const RankStats& rank : s.ranks) {
        sum += rank.seconds_busy();
        max = std::max(max, rank.seconds_busy());
    }
    return sum > 0 ? max * double(s.ranks.size()) / sum : 1;
}

static Json ranks_of(const RenderStats& s) {
    Json ranks = Json::array();
    for (size_t i = 0; i < s.ranks.size(); ++i) {
        const ovc_statistics& t = s.ranks[i].tracing;
        ranks.push_back({{"name", s.rank_names[i]},
                         {"rays", rays_of(s.ranks[i].rays)},
                         {"leaves", t.leaves},
                         {"level2_bytes", t.level2_bytes},
                         {"gpu_peak_bytes", t.gpu_peak_bytes},
                         {"host_peak_bytes", s.ranks[i].host_peak_bytes},
                         {"rays_sent", t.rays_sent},
                         {"rays_served", t.rays_served},
                         {"bytes_sent", t.bytes_sent},
                         {"bytes_received", t.bytes_received},
                         {"disk_bytes", t.disk_bytes},
                         {"time",
                          {{"trace", t.seconds_trace},
                           {"waiting", t.seconds_waiting},
                           {"cpu", s.ranks[i].seconds_cpu}}}});
    }
    return ranks;
}

static Json left_out_of(const RenderStats& s) {
    Json list = Json::array();
    for (const LeftOut& item : s.left_out)
        list.push_back({{"what", item.what}, {"bytes", item.bytes}});
    return list;
}

std::string stats_json(const RenderStats& s) {
    Json document = {{"scene", s.scene},
                     {"width", s.width},
                     {"height", s.height},
                     {"complete", s.report.complete},
                     {"renderer", s.renderer}};
    for_each_statistic(
        [&](const char* name, auto field, bool) { document[place_of(name)] = s.tracing.*field; });
    document["host_peak_bytes"] = host_peak_bytes();
    document["rays"] = rays_of(s.report.rays);
    document["left_out"] = left_out_of(s);
    document["from_cache"] = {{"scene", s.scene_from_cache}, {"levels", s.tracing.from_saved != 0}};
    document["time"]["import"] = s.seconds_import;
    add_times(document["time"], s.report);
    document["time"]["output"] = s.seconds_output;
    document["time"]["total"] = s.seconds_total;
    document["frames"] = frames_of(s);
    document["of_ranks"] = ranks_of(s);
    document["imbalance"] = imbalance(s);
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
    if (t.updates > 0)
        text +=
            fmt::format("  updates    {}: {} pages refitted, {} built\n", human_count(t.updates),
                        human_count(t.pages_refitted), human_count(t.pages_rebuilt));
    text += fmt::format("  moved      {} in {} pages, {} passes\n", human_bytes(t.bytes_in),
                        human_count(t.pages_in), human_count(t.passes));
    if (t.host_budget_bytes > 0)
        text +=
            fmt::format("  disk       {} in {} reads; {} of host memory at most, of a budget of "
                        "{}\n",
                        human_bytes(t.disk_bytes), human_count(t.disk_reads),
                        human_bytes(t.host_budget_peak_bytes), human_bytes(t.host_budget_bytes));
    return text;
}

static std::string ranks_line(const RenderStats& s) {
    uint64_t rays = 0, bytes = 0, host = 0, gpu = 0;
    for (const RankStats& rank : s.ranks) {
        rays += rank.tracing.rays_sent;
        bytes += rank.tracing.bytes_sent;
        host = std::max(host, rank.host_peak_bytes);
        gpu = std::max(gpu, rank.tracing.gpu_peak_bytes);
    }
    return fmt::format(
        "  ranks      {}: {} visits of rays to others, {} sent; {} of the GPU and {} "
        "of host memory at most; the busiest had {:.2f} times the mean to do\n",
        s.ranks.size(), human_count(rays), human_bytes(bytes), human_bytes(gpu), human_bytes(host),
        imbalance(s));
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
    if (!s.ranks.empty())
        text += ranks_line(s);
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
