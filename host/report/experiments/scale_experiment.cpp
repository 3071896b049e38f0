// SPDX-License-Identifier: Apache-2.0
// Measures what the plugin's work costs as rays, triangles, leaves and the budget grow.
#include "host/bench/sweep.h"
#include "host/report/experiments/experiment_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>
#include <thread>

namespace ovc {

namespace scale {

ReportRun sweep_run(const std::string& over, const std::vector<std::string>& more, double seconds) {
    ReportRun run{over, {"bench"}, "sweep.json", seconds};
    run.words.insert(run.words.end(), more.begin(), more.end());
    run.words.insert(run.words.end(), {"--sweep", over, "--json", "{}/sweep.json"});
    return run;
}

constexpr const char* kThreads = "threads-";

ReportRun thread_run(const std::string& scene, uint32_t threads, int repeat, bool quick) {
    return {fmt::format("{}{}-{}", kThreads, threads, repeat),
            {"render", scene, "--size", quick ? "512x512" : "1024x1024", "--threads",
             std::to_string(threads), "--quiet", "--stats", "{}/stats.json", "-o",
             "{}/picture.png"},
            "stats.json",
            2};
}

/// Returns renderings with 1, 2, 4, ... threads, and with as many as there are cores; three each.
std::vector<ReportRun> thread_runs(const std::string& scene, bool quick) {
    constexpr int repeats = 3;
    std::vector<ReportRun> runs;
    const uint32_t cores = std::max(1u, std::thread::hardware_concurrency());
    for (uint32_t threads = 1;; threads = std::min(2 * threads, cores)) {
        for (int repeat = 0; repeat < repeats; ++repeat)
            runs.push_back(thread_run(scene, threads, repeat, quick));
        if (threads == cores)
            return runs;
    }
}

std::vector<ReportRun> sweep_runs(const ReportPlan& plan, const std::string& scene) {
    if (plan.quick)
        return {
            sweep_run("rays", {scene, "--repeats", "3", "--most", "1000000"}, 15),
            sweep_run("triangles", {"--repeats", "3", "--size", "256x256", "--most", "400000"}, 15),
            sweep_run("leaves", {scene, "--repeats", "3", "--size", "256x256", "--most", "300"},
                      25),
            sweep_run("budget", {scene, "--repeats", "3", "--size", "256x256"}, 25)};
    return {sweep_run("rays", {scene}, 120), sweep_run("triangles", {}, 300),
            sweep_run("leaves", {scene}, 180), sweep_run("budget", {scene}, 120)};
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0]
                              : plan.mesh.empty()  ? "knot"
                                                   : plan.mesh;
    std::vector<ReportRun> runs = sweep_runs(plan, scene);
    for (ReportRun& run : thread_runs(scene, plan.quick))
        runs.push_back(std::move(run));
    return runs;
}

/// Returns the bench's JSON, with the scene's name instead of its path.
Json sweep_of(const Json& result) {
    Json sweep = result;
    const std::string source = result["scene"];
    sweep["scene"] = source.substr(source.find_last_of('/') + 1);
    return sweep;
}

/// Returns 2 for the key "threads-2-0".
int threads_in(const ReportRun& run) {
    return std::stoi(run.key.substr(std::string_view(kThreads).size()));
}

Json median_of(std::vector<double> values) {
    assert(!values.empty());
    std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(values.size() / 2));
    return values[values.size() / 2];
}

/// Returns a row for each number of threads, with medians of its runs.
Json threads_of(std::span<const RawResult> results) {
    std::map<int, std::vector<const Json*>> times;
    for (const RawResult& raw : results)
        if (raw.run.key.starts_with(kThreads))
            times[threads_in(raw.run)].push_back(&raw.result["time"]);
    Json rows = Json::array();
    for (const auto& [threads, of] : times) {
        std::vector<double> build, render, cpu;
        for (const Json* time : of) {
            build.push_back((*time)["level1"].get<double>() + (*time)["level2"].get<double>());
            render.push_back((*time)["render"]);
            cpu.push_back((*time)["cpu"]);
        }
        rows.push_back({{"threads", threads},
                        {"build_s", median_of(build)},
                        {"render_s", median_of(render)},
                        {"cpu_s", median_of(cpu)}});
    }
    return rows;
}

/// Returns the exponent of a column of threads_of(); -1 is perfectly parallel.
Json threads_exponent(const Json& rows, const char* column) {
    Sweep sweep;
    for (const Json& row : rows)
        sweep.rows.push_back({row["threads"], {row[column].get<double>()}});
    const std::optional<double> exponent = fitted_exponent(sweep, 0);
    return exponent ? Json(*exponent) : Json(nullptr);
}

struct Projected {
    double triangles;
    int machines;
};
constexpr Projected kProjected[] = {{1e9, 1}, {1e9, 100}, {1e11, 1}, {1e11, 1000}};

/// Returns the value at x of a column's power law through its last row, with an exponent of at
/// least min_exponent. Small scenes take part of their build time whatever their size, so the
/// fitted exponent of building is too low.
Json carried_on(const Json& sweep, const char* column, double x, double min_exponent) {
    const auto found = std::ranges::find(sweep["columns"], column);
    if (found == sweep["columns"].end())
        return nullptr;
    const size_t c = size_t(found - sweep["columns"].begin());
    const Json &exponent = sweep["exponents"][c], &last = sweep["rows"].back();
    if (exponent.is_null() || last["values"][c].is_null())
        return nullptr;
    return last["values"][c].get<double>() *
           std::pow(x / last["x"].get<double>(), std::max(min_exponent, exponent.get<double>()));
}

/// Returns what each of several machines would take, each with its share of the triangles.
Json projection_of(const Json& sweep) {
    Json rows = Json::array();
    for (const Projected& one : kProjected) {
        const double share = one.triangles / one.machines;
        const Json& last = sweep["rows"].back()["values"];
        const auto bytes = std::ranges::find(sweep["columns"], "bytes a triangle");
        const Json build = carried_on(sweep, "build s", share, 1);
        const Json call = carried_on(sweep, "primary: call s", share, 0);
        rows.push_back(
            {{"triangles", one.triangles},
             {"machines", one.machines},
             {"pages_gb", bytes == sweep["columns"].end()
                              ? Json(nullptr)
                              : Json(1e-9 * share *
                                     last[size_t(bytes - sweep["columns"].begin())].get<double>())},
             {"build_minutes", build.is_null() ? build : Json(build.get<double>() / 60)},
             {"call_s", call}});
    }
    return rows;
}

Json figures(std::span<const RawResult> results) {
    Json figures = {
        {"sweeps", Json::array()}, {"threads", threads_of(results)}, {"projection", Json::array()}};
    for (const char* column : {"build_s", "render_s"})
        figures["threads_exponents"][column] = threads_exponent(figures["threads"], column);
    for (const RawResult& raw : results) {
        if (raw.run.key.starts_with(kThreads))
            continue;
        figures["sweeps"].push_back(sweep_of(raw.result));
        if (raw.run.key == "triangles")
            figures["projection"] = projection_of(raw.result);
    }
    return figures;
}

bool is_time(const std::string& column) {
    return column.ends_with(" s");
}

/// Plots the times of a sweep: a row of data for each x, a curve for each column of seconds.
Plot plot_of(const Json& sweep) {
    const std::string over = sweep["over"];
    const Json& columns = sweep["columns"];
    std::string data = "# " + over, curves;
    for (size_t c = 0; c < columns.size(); ++c) {
        const std::string column = columns[c];
        data += "; " + column;
        if (is_time(column))
            curves += fmt::format("{}datafile using 1:{} with linespoints ls {} title '{}'",
                                  curves.empty() ? "" : ", ", c + 2, c % 5 + 1, column);
    }
    for (const Json& row : sweep["rows"]) {
        data += fmt::format("\n{:.6g}", row["x"].get<double>());
        for (const Json& value : row["values"])
            data += value.is_null() || value.get<double>() <= 0
                        ? " NaN"
                        : fmt::format(" {:.6g}", value.get<double>());
    }
    const std::string word = over.substr(0, over.find(' '));
    return {"scale-" + word, fmt::format("Seconds against {}, both in powers of ten.", over),
            data + "\n",
            fmt::format("set logscale xy\nset format y '10^{{%L}}'\nset format x '%.0s%c'\n"
                        "set xlabel '{}'\nset ylabel 'seconds'\nplot {}\n",
                        over, curves)};
}

Table table_of(const Json& figures, size_t s) {
    const Json& sweep = figures["sweeps"][s];
    const std::string at = fmt::format("/sweeps/{}", s);
    Table table;
    table.caption = fmt::format("As {} grow: {}", sweep["over"].get<std::string>(),
                                sweep["scene"].get<std::string>());
    table.header = {sweep["over"]};
    for (const Json& column : sweep["columns"])
        table.header.push_back(column);
    for (size_t r = 0; r < sweep["rows"].size(); ++r) {
        table.rows.push_back({{number(figures, fmt::format("{}/rows/{}/x", at, r))}});
        for (size_t c = 0; c < sweep["columns"].size(); ++c)
            table.rows.back().push_back(
                {number(figures, fmt::format("{}/rows/{}/values/{}", at, r, c))});
    }
    table.marked = table.rows.size();
    table.rows.push_back({{"exponent"}});
    for (size_t c = 0; c < sweep["columns"].size(); ++c)
        table.rows.back().push_back({number(figures, fmt::format("{}/exponents/{}", at, c))});
    return table;
}

Plot threads_plot(const Json& figures) {
    std::string data = "# threads, build s, render s\n";
    for (const Json& row : figures["threads"])
        data += fmt::format("{} {:.6g} {:.6g}\n", row["threads"].get<int>(),
                            row["build_s"].get<double>(), row["render_s"].get<double>());
    return {"scale-threads", "Seconds against threads.", data,
            "set xlabel 'threads'\nset ylabel 'seconds'\nset yrange [0:*]\nset xtics 1\n"
            "plot datafile using 1:2 with linespoints ls 1 title 'building', "
            "datafile using 1:3 with linespoints ls 2 title 'tracing and shading'\n"};
}

/// Returns a table of a list of objects, with a column for each key.
Table list_table(const Json& figures, const std::string& list, const std::string& caption,
                 const std::vector<std::string>& header, const std::vector<const char*>& keys) {
    Table table{caption, header, {}};
    for (size_t r = 0; r < figures[list].size(); ++r) {
        table.rows.emplace_back();
        for (const char* key : keys)
            table.rows.back().push_back({number(figures, fmt::format("/{}/{}/{}", list, r, key))});
    }
    return table;
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {
        Text{"Medians of calls in certified precision, from call to return. The exponent is that "
             "of the power law nearest to a column by least squares of logarithms: one is in "
             "proportion, zero costs nothing. A budget is a share of the bytes of all pages; an "
             "eighth of it goes to rays."}};
    for (const Json& sweep : figures["sweeps"])
        blocks.push_back(plot_of(sweep));
    for (size_t s = 0; s < figures["sweeps"].size(); ++s)
        blocks.push_back(table_of(figures, s));
    if (!figures["threads"].empty()) {
        blocks.push_back(Text{"More threads: medians of renderings. The exponent of building is ",
                              number(figures, "/threads_exponents/build_s"),
                              ", that of tracing and shading ",
                              number(figures, "/threads_exponents/render_s"),
                              "; minus one is perfectly parallel. A software renderer is told to "
                              "use as many as the host."});
        blocks.push_back(threads_plot(figures));
        blocks.push_back(list_table(figures, "threads", "As threads grow",
                                    {"threads", "build s", "trace and shade s", "CPU s"},
                                    {"threads", "build_s", "render_s", "cpu_s"}));
    }
    if (!figures["projection"].empty()) {
        blocks.push_back(
            Text{"A projection, not a measurement: the power laws of the triangles' table carried "
                 "on from its last row, building in proportion at least, with its bytes a "
                 "triangle. Of several machines each has "
                 "its share of the triangles in a tree of its own; rays between machines are not "
                 "counted, nor is memory that a machine has not got, where pages would come from "
                 "disk."});
        blocks.push_back(list_table(
            figures, "projection",
            "Projected: what a scene of so many triangles would take, on "
            "each machine",
            {"triangles", "machines", "pages GB", "build minutes", "the same primary rays: call s"},
            {"triangles", "machines", "pages_gb", "build_minutes", "call_s"}));
    }
    return blocks;
}

} // namespace scale

Experiment scale_experiment() {
    return {"scale",
            "Cost as work grows",
            "times of calls and builds as rays, triangles, leaves and the budget grow, with the "
            "exponents that fit",
            scale::runs,
            scale::figures,
            scale::blocks};
}

} // namespace ovc
