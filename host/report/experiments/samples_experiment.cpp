// SPDX-License-Identifier: Apache-2.0
// Compares the error of a picture with its time, by samples a pixel, beside Embree, povray and
// tachyon.
#include "host/report/experiments/experiment_table.h"
#include "host/report/page/frontier.h"
#include "host/report/page/frontier_plot.h"

#include <fmt/format.h>

#include <cmath>

namespace ovc {

namespace samples {

constexpr const char* kDefault = "certified, 1 sample";

struct Program {
    const char* name;
    const char* title;
};
/// The programs in the order of the plots' marks.
constexpr Program kPrograms[] = {{"certified", "certified"},     {"fast", "fast"},
                                 {"cpu-kdtree", "CPU, doubles"}, {"embree", "Embree"},
                                 {"povray", "povray"},           {"tachyon", "tachyon"}};

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty() && plan.quick)
        scenes = {"sphere-5"};
    else if (scenes.empty())
        scenes = {plan.mesh.empty() ? "knot" : plan.mesh, "plants-1"};
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        runs.push_back(
            {fmt::format("scene-{}", runs.size() + 1),
             {"bench", scene, "--pictures", "samples", "--size", plan.quick ? "128x128" : "256x256",
              "--most", plan.quick ? "16" : "64", "--repeats", "3", "--json", "{}/pictures.json"},
             "pictures.json",
             plan.quick ? 20.0 : 300.0});
    return runs;
}

/// Rounds an error to codes of 16 bits, in which other programs' pictures come, so that smaller
/// differences do not count.
double in_codes(double rmse) {
    constexpr double codes = 65535;
    return std::round(codes * rmse) / codes;
}

Json scene_of(const Json& bench) {
    Json choices = Json::array();
    for (const Json& c : bench["choices"])
        choices.push_back({{"choice", c["choice"]},
                           {"program", c["program"]},
                           {"samples", c["samples"]},
                           {"seconds", c["seconds"]},
                           {"cpu_seconds", c["cpu_seconds"]},
                           {"rmse", c["rmse"]},
                           {"host_peak_mb", megabytes(c["host_peak_bytes"])},
                           {"gpu_peak_mb", megabytes(c["gpu_peak_bytes"])},
                           {"moved_mb", megabytes(c["bytes_in"])}});
    judge_choices(
        choices, "seconds",
        [](const Json& c) { return std::vector<double>{in_codes(c["rmse"].get<double>())}; },
        [](const Json& c) { return c["program"] != "certified" && c["program"] != "fast"; });
    const std::string source = bench["scene"];
    return {{"scene", source.substr(source.find_last_of('/') + 1)},
            {"triangles", bench["triangles"]},
            {"size", bench["size"]},
            {"reference_samples", bench["reference_samples"]},
            {"not_installed", bench["not_installed"]},
            {"choices", choices}};
}

Json figures(std::span<const RawResult> results) {
    Json scenes = Json::array();
    for (const RawResult& raw : results)
        scenes.push_back(scene_of(raw.result));
    return {{"default", kDefault}, {"same_time_percent", 100 * kSameTime}, {"scenes", scenes}};
}

Plot plot_of(const Json& scene, size_t s) {
    std::vector<PlotSeries> series;
    for (const Program& program : kPrograms) {
        series.push_back({program.title, {}});
        for (const Json& c : scene["choices"])
            if (c["program"] == program.name)
                series.back().points.push_back({c["seconds"].get<double>(), c["rmse"].get<double>(),
                                                c["choice"].get<std::string>()});
    }
    return frontier_plot(fmt::format("samples-{}", s + 1),
                         "Error of the picture against time of the whole program; of one program, "
                         "more samples are lower.",
                         series, "s, from file to picture", "RMSE of the picture");
}

Table table_of(const Json& figures, const std::string& at, const Json& scene) {
    Table table;
    table.caption = "Pictures by samples a pixel; the default is marked";
    table.header = {"choice",      "samples",  "s",
                    "CPU s",       "RMSE",     "peak MB",
                    "GPU peak MB", "moved MB", "dominated by, its time"};
    for (size_t i = 0; i < scene["choices"].size(); ++i) {
        const std::string row = fmt::format("{}/choices/{}", at, i);
        const std::string name = scene["choices"][i]["choice"];
        if (name == kDefault)
            table.marked = i;
        table.rows.push_back({{name}});
        for (const char* key : {"samples", "seconds", "cpu_seconds", "rmse", "host_peak_mb",
                                "gpu_peak_mb", "moved_mb"})
            table.rows.back().push_back({number(figures, row + "/" + key)});
        table.rows.back().push_back(frontier_cell(figures, row));
    }
    return table;
}

/// Returns one sentence for each program that is missing.
Text missing_text(const Json& scene) {
    Text text;
    for (const Json& program : scene["not_installed"])
        text.push_back(program.get<std::string>() + " is not installed, and takes no part. ");
    return text;
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {Text{
        "The same triangles, in one gray, under one light with shadows: overcast and povray read "
        "the same file, tachyon another with the same numbers in it. "
        "The error is the root mean square over pixels and colors of linear light, white "
        "being one, to what the CPU's KD-tree in double precision draws with four times the "
        "most samples. Time is of the whole program, from file to picture. A choice is "
        "dominated when another has no larger error and is faster by more than ",
        number(figures, "/same_time_percent"),
        " %, or has a smaller one and is not slower. overcast's samples lie on a fixed "
        "pattern, povray's on a grid, where a pixel is unlike its neighbours, tachyon's are "
        "random. overcast's times have the opening of a GPU's device in them, or of the software "
        "renderer that stands for it, which Embree and the CPU's KD-tree do without."}};
    for (size_t s = 0; s < figures["scenes"].size(); ++s) {
        const Json& scene = figures["scenes"][s];
        const std::string at = fmt::format("/scenes/{}", s);
        blocks.push_back(Text{"Scene ", scene["scene"].get<std::string>(), ": ",
                              number(figures, at + "/triangles"), " triangles, ",
                              number(figures, at + "/size"), " pixels a side, compared with ",
                              number(figures, at + "/reference_samples"), " samples a pixel."});
        if (Text missing = missing_text(scene); !missing.empty())
            blocks.push_back(std::move(missing));
        blocks.push_back(
            default_text(figures, at + "/choices", "Pictures: ", kDefault, "seconds", "s"));
        blocks.push_back(plot_of(scene, s));
        blocks.push_back(table_of(figures, at, scene));
    }
    return blocks;
}

} // namespace samples

Experiment samples_experiment() {
    return {"samples",
            "Samples a pixel",
            "the error of a picture against time by samples a pixel, beside Embree, povray and "
            "tachyon",
            samples::runs,
            samples::figures,
            samples::blocks};
}

} // namespace ovc
