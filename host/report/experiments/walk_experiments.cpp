// SPDX-License-Identifier: Apache-2.0
// Measures plants and power plant along camera paths, frame by frame, as figures 4.10 to 4.15 of
// the thesis do.
#include "host/report/experiments/experiment_table.h"
#include "host/report/experiments/thesis_runs.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace {

/// A scene of the thesis, with the thesis' figures and results.
struct Walk {
    const char* name;
    const char* quick; // the scene of the quick form
    const char* full;
    int last_frame;
    const char *time_figure, *calls_figure, *rays_figure, *active_figure;
    const char *faster_than_kdt, *calls_ratio, *time_ratio; // as the thesis reports them
};

constexpr Walk kPlants = {"plants", "plants-10", "plants",          254,
                          "4.10",   "4.11 (a)",  "4.11 (b)",        "4.12",
                          "2.5",    "about 0.5", "slightly below 1"};
constexpr Walk kPowerplant = {"powerplant",
                              "powerplant-400000",
                              "powerplant",
                              274,
                              "4.13",
                              "4.14 (a)",
                              "4.14 (b)",
                              "4.15",
                              "over 10, its KD-tree being poor",
                              "nearly 1 indoors",
                              "slightly above 1"};

constexpr std::string_view kSystems[] = {"kdt", "batched", "mixed", "product-batched",
                                         "product-mixed"};

/// Returns the walk's scene, or the one that the plan asks for; empty where the plan asks for other
/// scenes alone.
std::string scene_of(const ReportPlan& plan, const Walk& walk) {
    if (plan.scenes.empty())
        return plan.quick ? walk.quick : walk.full;
    const auto found = std::ranges::find_if(
        plan.scenes, [&](const std::string& scene) { return scene.starts_with(walk.name); });
    return found == plan.scenes.end() ? "" : *found;
}

std::vector<ReportRun> runs(const ReportPlan& plan, const Walk& walk) {
    const std::string scene = scene_of(plan, walk);
    if (scene.empty())
        return {};
    const int pictures = plan.quick ? 6 : 24;
    const FramesAsked asked{
        scene,
        fmt::format("0:{}:{}", walk.last_frame, (walk.last_frame + pictures) / pictures),
        plan.quick ? "192x192" : "512x512",
        {}};
    std::vector<ReportRun> runs;
    for (const std::string_view system : kSystems)
        runs.push_back(frames_run(scene, thesis_system(system), asked, plan.quick ? 3 : 60));
    runs.push_back(working_set_run(scene, asked, plan.quick ? 3 : 60));
    return runs;
}

Json figures(std::span<const RawResult> results, const Walk& walk) {
    Json systems = Json::array();
    for (const RawResult& raw : results)
        systems.push_back(frames_of(split_run_key(raw.run.key).second, raw.result));
    const std::string renderer = renderer_of(results);
    const char* cost = cost_by(renderer).mean;
    const std::vector<Finding> findings = {
        {"two-level, mixed: times as fast as the CPU KD-tree", walk.faster_than_kdt,
         ratio_of(systems, cost, "kdt", "mixed"), ratio_of(systems, cost, "kdt", "product-mixed")},
        {"GPU calls, mixed over batched", walk.calls_ratio,
         ratio_of(systems, "mean_calls", "mixed", "batched"),
         ratio_of(systems, "mean_calls", "product-mixed", "product-batched")},
        {"time, mixed over batched", walk.time_ratio, ratio_of(systems, cost, "mixed", "batched"),
         ratio_of(systems, cost, "product-mixed", "product-batched")}};
    return {{"scene", results[0].result["scene"]},
            {"renderer", renderer},
            {"triangles", results[0].result["triangles"]},
            {"frames", results[0].result["frames"].size()},
            {"findings", findings_of(findings)},
            {"systems", systems}};
}

std::vector<Block> blocks(const Json& figures, const Walk& walk) {
    const Json& systems = figures["systems"];
    const FrameCost cost = cost_by(figures["renderer"]);
    const auto plot = [&](const char* what, const char* caption,
                          const std::vector<std::string_view>& keys, const char* quantity,
                          const char* label) {
        return frames_plot(fmt::format("{}-{}", walk.name, what), caption, systems, keys, quantity,
                           label);
    };
    const auto caption = [](const char* figure, const char* text) {
        return fmt::format("Figure {} of the thesis, here: {}", figure, text);
    };
    const std::vector<std::string_view> all(std::begin(kSystems), std::end(kSystems));
    const std::vector<std::string_view> gpu(all.begin() + 1, all.end());
    std::vector<Block> blocks = {
        Text{"Scene ", figures["scene"].get<std::string>(), ": ", number(figures, "/triangles"),
             " triangles, ", number(figures, "/frames"),
             " frames spread along the path of the thesis. Times are of tracing and shading, "
             "without building and files. A GPU call is a pass of the kernel."},
        Text{renderer_text(figures)},
        findings_table(figures),
        kdtree_text(figures, "/systems"),
        mixed_text(figures, "/systems"),
        plot("time", caption(walk.time_figure, "time a frame, with the CPU KD-tree.").c_str(), all,
             cost.list, cost.label),
        plot("gpu-time", caption(walk.time_figure, "without it.").c_str(), gpu, cost.list,
             cost.label),
        plot("calls", caption(walk.calls_figure, "GPU calls a frame.").c_str(), gpu, "calls",
             "GPU calls"),
        plot("rays", caption(walk.rays_figure, "rays a frame, the same in each system.").c_str(),
             {"mixed"}, "rays", "rays"),
        plot("active",
             caption(walk.active_figure, "the share of page bytes that a frame's rays go through.")
                 .c_str(),
             {"active"}, "active", "share of bytes"),
        plot("incremental",
             caption(walk.active_figure, "the share that no ray of the frame before went through.")
                 .c_str(),
             {"active"}, "incremental", "share of bytes")};
    blocks.push_back(systems_table(figures, "/systems", "Means of these frames"));
    return blocks;
}

} // namespace

Experiment plants_experiment() {
    return {"plants",
            "The thesis: plants",
            "figures 4.10 to 4.12 of the thesis: time, GPU calls, rays and pages in use, frame by "
            "frame",
            [](const ReportPlan& plan) { return runs(plan, kPlants); },
            [](std::span<const RawResult> results) { return figures(results, kPlants); },
            [](const Json& json) { return blocks(json, kPlants); }};
}

Experiment powerplant_experiment() {
    return {"powerplant",
            "The thesis: power plant",
            "figures 4.13 to 4.15 of the thesis, the same in a building",
            [](const ReportPlan& plan) { return runs(plan, kPowerplant); },
            [](std::span<const RawResult> results) { return figures(results, kPowerplant); },
            [](const Json& json) { return blocks(json, kPowerplant); }};
}

} // namespace ovc
