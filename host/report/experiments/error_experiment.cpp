// SPDX-License-Identifier: Apache-2.0
// Error against run time compares every contender of the bench, under several leaves and budgets,
// with the CPU KD-tree in doubles.
#include "host/bench/contender.h"
#include "host/report/experiments/experiment_table.h"
#include "host/report/page/frontier.h"
#include "host/report/page/frontier_plot.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ovc {

namespace error {

constexpr std::string_view kDefault = "certified-compute, auto leaves, budget all";

/// Returns a run of `bench` on the scene with these contenders and settings.
ReportRun run_of(const std::string& key, const std::string& scene, const std::string& contenders,
                 const std::vector<std::string>& settings, bool quick, double seconds) {
    ReportRun run{key, {"bench", scene, "--only", contenders}, "bench.json", seconds};
    run.words.insert(run.words.end(), settings.begin(), settings.end());
    run.words.insert(run.words.end(), {"--workloads", "primary,diffuse,edges", "--size",
                                       quick ? "256x256" : "512x512", "--repeats",
                                       quick ? "3" : "5", "--json", "{}/bench.json"});
    return run;
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty()) {
        scenes.push_back(!plan.mesh.empty() ? plan.mesh : plan.quick ? "sphere-7" : "knot");
        if (!plan.quick)
            scenes.insert(scenes.end(), {"soup-500", "powerplant-400000", "plants-10"});
    }
    const std::string peers = has_embree() ? ",cpu,embree" : ",cpu";
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        runs.push_back(
            run_of(fmt::format("scene-{}", runs.size() + 1), scene, "certified,fast" + peers,
                   {"--leaves", plan.quick ? "auto,100" : "auto,16,100", "--resident", "all,30%"},
                   plan.quick, plan.quick ? 75 : 240));
    // Two of the thesis' systems build a tree by a slow and careful rule, so they get one scene, a
    // small one in the quick form.
    runs.push_back(
        run_of("systems", plan.quick && plan.scenes.empty() ? std::string("sphere-6") : scenes[0],
               "certified-compute,fast-compute,thesis" + peers,
               {"--leaves", "auto", "--resident", "all"}, plan.quick, plan.quick ? 20 : 240));
    return runs;
}

Json per_million(const Json& count, double rays) {
    return count.is_null() || rays == 0 ? Json(nullptr) : Json(1e6 * count.get<double>() / rays);
}

Json nanoseconds(const Json& spread, double rays) {
    return spread.is_null() || rays == 0 ? Json(nullptr)
                                         : Json(1e9 * spread["median"].get<double>() / rays);
}

Json choice_of(const Json& m, const Json& contender) {
    const double rays = m["rays"].get<double>();
    return {{"choice", m["contender"]},
            {"call_ns", nanoseconds(m["call_seconds"], rays)},
            {"cpu_ns", nanoseconds(m["cpu_seconds"], rays)},
            {"kernel_ns", nanoseconds(m["kernel_seconds"], rays)},
            {"wrong_per_million", per_million(m["differ"], rays)},
            {"leaks_per_million", per_million(m["missed"], rays)},
            {"t_error_largest", m["t_error_largest"]},
            {"t_error_rms", m["t_error_rms"]},
            {"pages_mb", megabytes(contender["level2_bytes"])},
            {"gpu_peak_mb", megabytes(contender["gpu_peak_bytes"])},
            {"moved_mb",
             contender["level2_bytes"].is_null() ? Json(nullptr) : megabytes(m["bytes_in"])}};
}

std::vector<double> errors_of(const Json& c) {
    return {c["wrong_per_million"].get<double>(), c["leaks_per_million"].get<double>(),
            c["t_error_rms"].get<double>(), c["t_error_largest"].get<double>()};
}

const Json& named(const Json& list, const char* key, const Json& name) {
    for (const Json& one : list)
        if (one[key] == name)
            return one;
    throw std::runtime_error("no contender " + name.dump()); // the bench did not write the file
}

bool is_peer(const Json& choice) {
    const std::string name = choice["choice"];
    return !name.starts_with("certified") && !name.starts_with("fast");
}

Json scene_of(const Json& bench) {
    const Json& scene = bench["scenes"].at(0);
    Json workloads = Json::array();
    for (const Json& m : scene["measurements"]) {
        if (workloads.empty() || workloads.back()["workload"] != m["workload"])
            workloads.push_back(
                {{"workload", m["workload"]}, {"rays", m["rays"]}, {"choices", Json::array()}});
        workloads.back()["choices"].push_back(
            choice_of(m, named(scene["contenders"], "label", m["contender"])));
    }
    for (Json& workload : workloads)
        judge_choices(workload["choices"], "call_ns", errors_of, is_peer);
    const std::string source = scene["scene"];
    return {{"scene", source.substr(source.find_last_of('/') + 1)},
            {"renderer", scene["contenders"].at(0)["renderer"]},
            {"triangles", scene["triangles"]},
            {"threads", scene["threads"]},
            {"repeats", scene["repeats"]},
            {"workloads", workloads}};
}

Json figures(std::span<const RawResult> results) {
    Json scenes = Json::array();
    for (const RawResult& raw : results)
        scenes.push_back(scene_of(raw.result));
    return {{"same_time_percent", 100 * kSameTime}, {"scenes", scenes}};
}

/// Returns the index of the series that a choice belongs to.
size_t family(const std::string& choice) {
    constexpr std::string_view starts[] = {"certified", "fast", "cpu", "embree", "thesis"};
    for (size_t i = 0; i + 1 < std::size(starts); ++i)
        if (choice.starts_with(starts[i]))
            return i;
    return std::size(starts) - 1;
}

/// Plots the choices of a workload, a series for each family.
Plot plot_of(const std::string& name, const Json& workload, const char* error,
             const std::string& label) {
    std::vector<PlotSeries> series = {
        {"certified", {}}, {"fast", {}}, {"CPU KD-tree", {}}, {"Embree", {}}, {"the thesis", {}}};
    for (const Json& c : workload["choices"])
        series[family(c["choice"])].points.push_back(
            {c["call_ns"].get<double>(), c[error].get<double>(), c["choice"].get<std::string>()});
    return frontier_plot(name,
                         fmt::format("{} rays: {} against time. \"none\" is no error at all.",
                                     workload["workload"].get<std::string>(), label),
                         series, "ns a ray, from call to return", label);
}

std::vector<Text> row_of(const Json& figures, const std::string& at, const Json& c) {
    std::vector<Text> row = {{c["choice"].get<std::string>()}};
    for (const char* key :
         {"call_ns", "kernel_ns", "wrong_per_million", "leaks_per_million", "t_error_rms",
          "t_error_largest", "pages_mb", "gpu_peak_mb", "moved_mb"})
        row.push_back({number(figures, at + "/" + key)});
    row.push_back(frontier_cell(figures, at));
    return row;
}

Table table_of(const Json& figures, const std::string& at, const Json& workload) {
    Table table;
    table.caption = workload["workload"].get<std::string>() +
                    " rays: time, error and bytes of each choice; the default is marked";
    table.header = {"choice",      "call ns/ray",  "kernel ns/ray",         "wrong / 1e6",
                    "leaks / 1e6", "t error, RMS", "t error, largest",      "pages MB",
                    "GPU peak MB", "moved MB",     "dominated by, its time"};
    const Json& choices = workload["choices"];
    for (size_t i = 0; i < choices.size(); ++i) {
        if (choices[i]["choice"] == kDefault)
            table.marked = i;
        table.rows.push_back(row_of(figures, fmt::format("{}/choices/{}", at, i), choices[i]));
    }
    return table;
}

void add_workload(const Json& figures, size_t s, size_t w, std::vector<Block>& blocks) {
    const Json& workload = figures["scenes"][s]["workloads"][w];
    const std::string at = fmt::format("/scenes/{}/workloads/{}", s, w);
    if (Text text = default_text(figures, at + "/choices",
                                 workload["workload"].get<std::string>() + " rays: ",
                                 std::string(kDefault), "call_ns", "ns a ray");
        !text.empty())
        blocks.push_back(std::move(text));
    const std::string stem =
        fmt::format("error-{}-{}", s + 1, workload["workload"].get<std::string>());
    blocks.push_back(
        plot_of(stem + "-wrong", workload, "wrong_per_million", "wrong ids per million"));
    blocks.push_back(plot_of(stem + "-t", workload, "t_error_rms", "RMS relative error of t"));
    blocks.push_back(table_of(figures, at, workload));
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {Text{
        "Each choice of precision, kernel, leaves and budget, and each peer, answers the same rays "
        "in turn within one process. An id is wrong when it is not that of the CPU KD-tree in "
        "double precision; a leak is a ray that should hit and is answered as a miss. A choice "
        "is dominated when another has no larger error of any kind and is faster by more than ",
        number(figures, "/same_time_percent"),
        " %, or has a smaller one and is not slower. GPU memory is not looked at in that: a budget "
        "saves it, and pays in time. Edges: rays at corners and edges of triangles, where "
        "neighbours may leave a gap. The last scene has the systems of the thesis beside the "
        "default. Where the renderer is software, the kernel runs on the CPU that its peers run "
        "on, many rays in step: what they walk ray by ray is then faster where rays end after few "
        "steps, and a KD-tree, which cuts triangles, where boxes of slivers overlap."}};
    const Json& scenes = figures["scenes"];
    for (size_t s = 0; s < scenes.size(); ++s) {
        const std::string at = fmt::format("/scenes/{}", s);
        blocks.push_back(Text{"Scene ", scenes[s]["scene"].get<std::string>(), ": ",
                              number(figures, at + "/triangles"), " triangles, ",
                              number(figures, at + "/threads"), " threads, medians of ",
                              number(figures, at + "/repeats"), " calls; ",
                              scenes[s]["renderer"].get<std::string>(), "."});
        for (size_t w = 0; w < scenes[s]["workloads"].size(); ++w)
            add_workload(figures, s, w, blocks);
    }
    return blocks;
}

} // namespace error

Experiment error_experiment() {
    return {"error",
            "Error against run time",
            "what each choice of precision, kernel, leaves and budget costs, beside the CPU's "
            "KD-trees and Embree, and how wrong it is",
            error::runs,
            error::figures,
            error::blocks};
}

} // namespace ovc
