// SPDX-License-Identifier: Apache-2.0
// Error against run time: every contender of the bench, under several leaves and budgets, against
// the CPU KD-tree in doubles.
#include "host/bench/contender.h"
#include "host/report/experiment_table.h"
#include "host/report/frontier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace ovc {

namespace {

constexpr std::string_view kDefault = "certified-compute, auto leaves, budget all";

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty()) {
        scenes.push_back(plan.mesh.empty() ? "knot" : plan.mesh);
        if (!plan.quick)
            scenes.insert(scenes.end(), {"soup-500", "powerplant-400000", "plants-10"});
    }
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        runs.push_back({fmt::format("scene-{}", runs.size() + 1),
                        {"bench", scene, "--only",
                         has_embree() ? "certified,fast,cpu,embree" : "certified,fast,cpu",
                         "--leaves", "auto,1,100", "--resident", "all,30%", "--workloads",
                         "primary,diffuse,edges", "--size", plan.quick ? "320x320" : "1024x1024",
                         "--repeats", plan.quick ? "3" : "5", "--json", "{}/bench.json"},
                        "bench.json",
                        plan.quick ? 75.0 : 240.0});
    return runs;
}

Json per_million(const Json& count, double rays) {
    return count.is_null() || rays == 0 ? Json(nullptr) : Json(1e6 * count.get<double>() / rays);
}

Json nanoseconds(const Json& spread, double rays) {
    return spread.is_null() || rays == 0 ? Json(nullptr)
                                         : Json(1e9 * spread["median"].get<double>() / rays);
}

Json megabytes(const Json& bytes) {
    return bytes.is_null() ? bytes : Json(1e-6 * bytes.get<double>());
}

Json choice_of(const Json& m, const Json& contender) {
    const double rays = m["rays"].get<double>();
    return {{"choice", m["contender"]},
            {"call_ns", nanoseconds(m["call_seconds"], rays)},
            {"cpu_ns", nanoseconds(m["cpu_seconds"], rays)},
            {"kernel_ns", nanoseconds(m["kernel_seconds"], rays)},
            {"wrong_per_million", per_million(m["differ"], rays)},
            {"missed_per_million", per_million(m["missed"], rays)},
            {"t_error_largest", m["t_error_largest"]},
            {"t_error_rms", m["t_error_rms"]},
            {"pages_mb", megabytes(contender["level2_bytes"])},
            {"gpu_peak_mb", megabytes(contender["gpu_peak_bytes"])},
            {"moved_mb",
             contender["level2_bytes"].is_null() ? Json(nullptr) : megabytes(m["bytes_in"])}};
}

/// Adds to each choice who is better, and by how much.
void judge(Json& choices) {
    std::vector<Choice> costs;
    for (const Json& c : choices)
        costs.push_back(
            {c["call_ns"].get<double>(),
             {c["wrong_per_million"].get<double>(), c["missed_per_million"].get<double>(),
              c["t_error_rms"].get<double>(), c["t_error_largest"].get<double>()}});
    for (size_t i = 0; i < costs.size(); ++i) {
        const std::optional<size_t> better = dominating(costs, i);
        choices[i]["dominated_by"] = better ? choices[*better]["choice"] : Json(nullptr);
        choices[i]["its_time_to_that"] =
            better ? Json(costs[i].seconds / costs[*better].seconds) : Json(nullptr);
    }
}

const Json& named(const Json& list, const char* key, const Json& name) {
    for (const Json& one : list)
        if (one[key] == name)
            return one;
    throw std::runtime_error("no contender " + name.dump()); // not a file of the bench
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
        judge(workload["choices"]);
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

/// The family of a choice, which has its own marks: 1 to 4.
int family(const std::string& choice) {
    constexpr std::string_view starts[] = {"certified", "fast", "cpu", "embree"};
    for (int i = 0; i < 4; ++i)
        if (choice.starts_with(starts[i]))
            return i + 1;
    return 5;
}

double least_above_zero(const Json& choices, const char* error) {
    double least = std::numeric_limits<double>::infinity();
    for (const Json& c : choices)
        if (const double value = c[error].get<double>(); value > 0)
            least = std::min(least, value);
    return std::isfinite(least) ? least : 1;
}

/// The lower left staircase of two costs, point by point.
std::vector<std::pair<double, double>> staircase(std::vector<std::pair<double, double>> points) {
    std::sort(points.begin(), points.end());
    std::vector<std::pair<double, double>> stairs;
    for (const auto& [x, y] : points)
        if (stairs.empty() || y < stairs.back().second)
            stairs.emplace_back(x, y);
    return stairs;
}

/// Where no error at all is drawn: below the smallest one, and between two powers of ten, whose
/// labels it would meet.
double foot_of(const Json& choices, const char* error) {
    return std::pow(10, std::floor(std::log10(least_above_zero(choices, error))) - 0.5);
}

/// One block of data a family, then the frontier. None of an error has its own line at the foot.
Plot plot_of(const std::string& name, const Json& workload, const char* error,
             const std::string& label) {
    const Json& choices = workload["choices"];
    const double foot = foot_of(choices, error);
    std::vector<std::pair<double, double>> points;
    std::string data = "# ns a ray, error (0 at the foot), choice\n";
    std::string with;
    constexpr const char* titles[] = {"certified", "fast", "CPU KD-tree", "Embree"};
    int block = 0;
    for (int f = 1; f <= 4; ++f) {
        std::string lines;
        for (const Json& c : choices) {
            if (family(c["choice"]) != f)
                continue;
            const double y = std::max(c[error].get<double>(), foot);
            points.emplace_back(c["call_ns"].get<double>(), y);
            lines += fmt::format("{:.6g} {:.6g} \"{}\"\n", points.back().first, y,
                                 c["choice"].get<std::string>());
        }
        if (lines.empty())
            continue;
        data += lines + "\n\n";
        with += fmt::format("datafile index {} using 1:2 with points ls {} title '{}', ", block++,
                            f, titles[f - 1]);
    }
    for (const auto& [x, y] : staircase(points))
        data += fmt::format("{:.6g} {:.6g}\n", x, y);
    std::string script = fmt::format(
        "set logscale xy\nset format y '10^{{%L}}'\nset xlabel 'ns a ray, from call to return'\n"
        "set ylabel '{}'\nset ytics add ('none' {:.6g})\nset yrange [{:.6g}:*]\n"
        "set offsets graph 0.05, graph 0.05, graph 0.1, 0\n"
        "plot {}datafile index {} using 1:2 with steps ls 9 title 'frontier'\n",
        label, foot, foot / 3, with, block);
    return {name,
            fmt::format("{} rays: {} against time. \"none\" is no error at all.",
                        workload["workload"].get<std::string>(), label),
            data, script};
}

Text default_of(const Json& figures, const std::string& at, const Json& workload) {
    const Json& choices = workload["choices"];
    for (size_t i = 0; i < choices.size(); ++i) {
        if (choices[i]["choice"] != kDefault)
            continue;
        const std::string row = fmt::format("{}/choices/{}", at, i);
        const std::string rays = workload["workload"].get<std::string>() + " rays: the default, ";
        if (choices[i]["dominated_by"].is_null())
            return {rays + std::string(kDefault) + ", lies on the frontier, at ",
                    number(figures, row + "/call_ns"), " ns a ray."};
        return {rays + std::string(kDefault) + ", does not lie on the frontier: ",
                choices[i]["dominated_by"].get<std::string>(),
                " is no more wrong, and the default takes ",
                number(figures, row + "/its_time_to_that"), " times its time."};
    }
    return {};
}

std::vector<Text> row_of(const Json& figures, const std::string& at, const Json& c) {
    std::vector<Text> row = {{c["choice"].get<std::string>()}};
    for (const char* key :
         {"call_ns", "kernel_ns", "wrong_per_million", "missed_per_million", "t_error_rms",
          "t_error_largest", "pages_mb", "gpu_peak_mb", "moved_mb"})
        row.push_back({number(figures, at + "/" + key)});
    if (c["dominated_by"].is_null())
        row.push_back({"on the frontier"});
    else
        row.push_back({c["dominated_by"].get<std::string>(), ", ",
                       number(figures, at + "/its_time_to_that"), " x"});
    return row;
}

Table table_of(const Json& figures, const std::string& at, const Json& workload) {
    Table table;
    table.caption = workload["workload"].get<std::string>() +
                    " rays: time, error and bytes of each choice; the default is marked";
    table.header = {"choice",       "call ns/ray",  "kernel ns/ray",         "wrong / 1e6",
                    "missed / 1e6", "t error, RMS", "t error, largest",      "pages MB",
                    "GPU peak MB",  "moved MB",     "dominated by, its time"};
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
    blocks.push_back(default_of(figures, at, workload));
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
        "double precision; a ray is missed when it should hit and is answered as a miss. A choice "
        "is dominated when another has no larger error of any kind and is faster by more than ",
        number(figures, "/same_time_percent"),
        " %, or has a smaller one and is not slower. GPU memory is not looked at in that: a budget "
        "saves it, and pays in time. Edges: rays at corners and edges of triangles, where "
        "neighbours may leave a gap."}};
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

} // namespace

Experiment error_experiment() {
    return {"error",
            "Error against run time",
            "what each choice of precision, kernel, leaves and budget costs, beside the CPU's "
            "KD-trees and Embree, and how wrong it is",
            runs,
            figures,
            blocks};
}

} // namespace ovc
