// SPDX-License-Identifier: Apache-2.0
// Scale: what the plugin's work costs as rays, triangles, leaves and the budget grow.
#include "host/report/experiment_table.h"

#include <fmt/format.h>

namespace ovc {

namespace {

ReportRun sweep_run(const std::string& over, const std::vector<std::string>& more, double seconds) {
    ReportRun run{over, {"bench"}, "sweep.json", seconds};
    run.words.insert(run.words.end(), more.begin(), more.end());
    run.words.insert(run.words.end(), {"--sweep", over, "--json", "{}/sweep.json"});
    return run;
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    const std::string scene = !plan.scenes.empty() ? plan.scenes[0]
                              : plan.mesh.empty()  ? "knot"
                                                   : plan.mesh;
    if (plan.quick)
        return {sweep_run("rays", {scene, "--repeats", "3", "--most", "1000000"}, 15),
                sweep_run("triangles", {"--repeats", "3", "--size", "256x256", "--most", "1500000"},
                          15),
                sweep_run("leaves", {scene, "--repeats", "3", "--size", "256x256", "--most", "300"},
                          25),
                sweep_run("budget", {scene, "--repeats", "3", "--size", "256x256"}, 25)};
    return {sweep_run("rays", {scene}, 120), sweep_run("triangles", {}, 300),
            sweep_run("leaves", {scene}, 180), sweep_run("budget", {scene}, 120)};
}

/// As the bench leaves it, but for the folder of its scene.
Json figures(std::span<const RawResult> results) {
    Json sweeps = Json::array();
    for (const RawResult& raw : results) {
        sweeps.push_back(raw.result);
        const std::string source = raw.result["scene"];
        sweeps.back()["scene"] = source.substr(source.find_last_of('/') + 1);
    }
    return {{"sweeps", sweeps}};
}

bool is_time(const std::string& column) {
    return column.ends_with(" s");
}

/// Times alone: a row of data for each x, a curve for each column.
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
    return blocks;
}

} // namespace

Experiment scale_experiment() {
    return {"scale",
            "Cost as work grows",
            "times of calls and builds as rays, triangles, leaves and the budget grow, with the "
            "exponents that fit",
            runs,
            figures,
            blocks};
}

} // namespace ovc
