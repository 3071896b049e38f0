// SPDX-License-Identifier: Apache-2.0
// Shows the stability suite as a table, and heat maps over scale, offset and aspect, beside Embree.
#include "host/report/experiments/experiment_table.h"
#include "host/report/stability/stability_grid.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace ovc {

namespace hard {

struct Program {
    const char* key; // in stability.json
    const char* name;
};

constexpr Program kPrograms[] = {{"certified", "certified"},
                                 {"fast", "fast"},
                                 {"embree_robust", "Embree robust"},
                                 {"embree_default", "Embree default"}};

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const auto& [name, seconds] : {std::pair("grid", 40.0), std::pair("stability", 60.0)}) {
        ReportRun run{name,
                      {"report", "--only", name, "-o", "{}"},
                      name + std::string(".json"),
                      plan.quick ? seconds : 6 * seconds};
        if (plan.quick)
            run.words.push_back("--quick");
        runs.push_back(std::move(run));
    }
    return runs;
}

Json per_million(const Json& count, const Json& one) {
    const double rays = one["rays"].get<double>();
    return rays > 0 ? Json(1e6 * count.get<double>() / rays) : Json(nullptr);
}

/// Returns the scores of each program in a case. They are null for a program that was not asked,
/// and leaks are null in a case that is not closed.
Json case_of(const Json& one) {
    Json object = {{"name", one["name"]},
                   {"triangles", one["triangles"]},
                   {"rays", one["rays"]},
                   {"retraced_per_million", per_million(one["retraced"], one)},
                   {"microseconds", one["microseconds"]}};
    if (one.contains("time_ratio"))
        object["time_ratio"] = one["time_ratio"];
    for (const Program& program : kPrograms) {
        const bool asked = one.contains(program.key);
        const bool closed = one["closed"].get<bool>();
        Json& of = object[program.key];
        of["wrong_per_million"] =
            asked ? per_million(one[program.key]["wrong"], one) : Json(nullptr);
        of["leaks_per_million"] =
            asked && closed ? per_million(one[program.key]["leaks"], one) : Json(nullptr);
        of["t_error"] = asked ? one[program.key]["t_error"] : Json(nullptr);
    }
    return object;
}

const Json* find_case(const Json& cases, const std::string& name) {
    for (const Json& one : cases)
        if (one["name"] == name)
            return &one;
    return nullptr;
}

Json grid_of(const Json& cases) {
    Json grid = Json::array();
    for (const GridPoint& point : stability_grid(/* quick= */ false))
        if (const Json* one = find_case(cases, point.name())) {
            grid.push_back(case_of(*one));
            grid.back()["aspect_power"] = point.aspect_power;
            grid.back()["scale_power"] = point.scale_power;
            grid.back()["offset_power"] = point.offset_power;
        }
    return grid;
}

Json figures(std::span<const RawResult> results) {
    Json figures = {{"grid", Json::array()}, {"cases", Json::array()}, {"optics", Json::array()}};
    for (const RawResult& raw : results) {
        if (raw.run.key == "grid") {
            figures["grid"] = grid_of(raw.result["cases"]);
            continue;
        }
        for (const Json& one : raw.result["cases"])
            figures["cases"].push_back(case_of(one));
        if (raw.result.contains("optics"))
            figures["optics"] = raw.result["optics"];
    }
    double rays = 0;
    std::map<std::string, double> wrong;
    for (const char* list : {"grid", "cases"})
        for (const Json& one : figures[list]) {
            rays += one["rays"].get<double>();
            for (const Program& program : kPrograms)
                if (const Json& of = one[program.key]["wrong_per_million"]; !of.is_null())
                    wrong[program.key] += 1e-6 * of.get<double>() * one["rays"].get<double>();
        }
    figures["rays"] = rays;
    for (const auto& [key, count] : wrong)
        figures["wrong"][key] = std::round(count);
    return figures;
}

bool was_asked(const Json& list, const Program& program) {
    for (const Json& one : list)
        if (!one[program.key]["wrong_per_million"].is_null())
            return true;
    return false;
}

/// The axes of a heat map.
struct MapAxes {
    std::vector<std::pair<int, int>> columns; // aspect, offset
    std::vector<int> rows;                    // scales
};

MapAxes axes_of(const Json& grid) {
    MapAxes axes;
    for (const Json& one : grid) {
        const std::pair column(one["aspect_power"].get<int>(), one["offset_power"].get<int>());
        if (std::ranges::find(axes.columns, column) == axes.columns.end())
            axes.columns.push_back(column);
        if (const int row = one["scale_power"];
            std::ranges::find(axes.rows, row) == axes.rows.end())
            axes.rows.push_back(row);
    }
    return axes;
}

std::string map_tics(const MapAxes& axes) {
    std::string tics = "set xtics (";
    for (size_t c = 0; c < axes.columns.size(); ++c) {
        const int offset = axes.columns[c].second;
        tics += fmt::format("{}'{}' {}", c ? ", " : "",
                            offset < 0 ? "0" : fmt::format("10^{}", offset), c);
    }
    tics += ")\nset ytics (";
    for (size_t r = 0; r < axes.rows.size(); ++r)
        tics += fmt::format("{}'2^{{{}}}' {}", r ? ", " : "", axes.rows[r], r);
    tics += ")\n";
    int aspect = -1;
    for (size_t c = 0; c < axes.columns.size(); ++c)
        if (axes.columns[c].first != aspect) {
            aspect = axes.columns[c].first;
            tics += fmt::format("set label 'aspect 10^{}' at {},{} front\n", aspect,
                                double(c) - 0.4, double(axes.rows.size()) - 0.3);
            if (c)
                tics += fmt::format("set arrow from {0},-0.5 to {0},{1} nohead lw 1.5 lc rgb "
                                    "'#808080' front\n",
                                    double(c) - 0.5, double(axes.rows.size()) - 0.5);
        }
    return tics;
}

Plot map_of(const Json& grid, const Program& program) {
    const MapAxes axes = axes_of(grid);
    std::string data = "# column, row, wrong answers per million (at least 1, for the logarithm)\n";
    for (size_t r = 0; r < axes.rows.size(); ++r) {
        for (const Json& one : grid) {
            if (one["scale_power"] != axes.rows[r])
                continue;
            const std::pair column(one["aspect_power"].get<int>(), one["offset_power"].get<int>());
            const auto c = std::ranges::find(axes.columns, column) - axes.columns.begin();
            const double wrong = one[program.key]["wrong_per_million"].get<double>();
            data += fmt::format("{} {} {:.6g}\n", c, r, std::max(1.0, wrong));
        }
        data += "\n";
    }
    const std::string script =
        map_tics(axes) +
        fmt::format(
            "unset key\nunset grid\nset border 15\nset tics scale 0\n"
            "set logscale cb\nset cbrange [1:1e6]\n"
            "set cbtics ('none' 1, '10' 10, '100' 100, '10^3' 1e3, '10^4' 1e4, '10^5' 1e5, "
            "'all' 1e6)\n"
            "set palette defined (0 '#2a6f97', 0.35 '#8cc6b0', 0.6 '#f2d388', 1 '#c2452d')\n"
            "set xrange [-0.5:{}]\nset yrange [-0.5:{}]\nset tmargin 4\n"
            "set xlabel 'offset from the origin, in lengths'\nset ylabel 'scale'\n"
            "set title '{}' offset 0,0.8\n"
            "plot datafile using 1:2:3 with image pixels\n",
            double(axes.columns.size()) - 0.5, double(axes.rows.size()) - 0.5, program.name);
    return {fmt::format("hard-map-{}", program.key),
            fmt::format("{}: wrong answers per million at each scale, offset and aspect.",
                        program.name),
            data, script};
}

Table cases_of(const Json& figures, const std::string& list, const std::string& caption) {
    Table table;
    table.caption = caption;
    table.header = {"case", "triangles", "rays"};
    std::vector<Program> asked;
    for (const Program& program : kPrograms)
        if (was_asked(figures[list], program)) {
            asked.push_back(program);
            for (const char* what : {"wrong / 1e6", "leaks / 1e6", "largest t error"})
                table.header.push_back(fmt::format("{}: {}", program.name, what));
        }
    for (size_t i = 0; i < figures[list].size(); ++i) {
        const std::string at = fmt::format("/{}/{}", list, i);
        table.rows.push_back({{figures[list][i]["name"].get<std::string>()},
                              {number(figures, at + "/triangles")},
                              {number(figures, at + "/rays")}});
        for (const Program& program : asked)
            for (const char* key : {"wrong_per_million", "leaks_per_million", "t_error"})
                table.rows.back().push_back(
                    {number(figures, fmt::format("{}/{}/{}", at, program.key, key))});
    }
    return table;
}

/// Returns the table of cases that are timed against another case.
Table costs_of(const Json& figures) {
    Table table;
    table.caption = "What the hardest rays cost: microseconds a ray, from call to return, and how "
                    "many times that of a ray "
                    "that is decided exactly (the bar is 100), or of a valid one";
    table.header = {"case", "triangles", "rays", "us / ray", "times"};
    for (size_t i = 0; i < figures["cases"].size(); ++i) {
        if (!figures["cases"][i].contains("time_ratio"))
            continue;
        const std::string at = fmt::format("/cases/{}", i);
        table.rows.push_back({{figures["cases"][i]["name"].get<std::string>()}});
        for (const char* key : {"triangles", "rays", "microseconds", "time_ratio"})
            table.rows.back().push_back({number(figures, at + "/" + key)});
    }
    return table;
}

Table optics_of(const Json& figures) {
    Table table;
    table.caption = "Stiff optics: rays spawned on shapes small and large, refraction, mirrors";
    table.header = {"case", "rays", "wrong", "leaks", "largest error"};
    for (size_t i = 0; i < figures["optics"].size(); ++i) {
        const std::string at = fmt::format("/optics/{}", i);
        table.rows.push_back({{figures["optics"][i]["name"].get<std::string>()},
                              {number(figures, at + "/rays")},
                              {number(figures, at + "/wrong")},
                              {number(figures, at + "/leaks")},
                              {number(figures, at + "/error")}});
    }
    return table;
}

Text sums_of(const Json& figures) {
    Text text = {"Of ", number(figures, "/rays"), " rays, wrong are"};
    for (const Program& program : kPrograms)
        if (figures["wrong"].contains(program.key)) {
            text.push_back(fmt::format("{} {}: ", text.size() > 3 ? "," : "", program.name));
            text.push_back(number(figures, fmt::format("/wrong/{}", program.key)));
        }
    text.push_back(". Certified is wrong where any bit of its answer is not that of double "
                   "precision; the others where they name another triangle that is not at the "
                   "same distance. A leak is a ray that must hit a closed mesh, and does not.");
    return text;
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {sums_of(figures)};
    if (!figures["grid"].empty()) {
        for (const Program& program : kPrograms)
            if (was_asked(figures["grid"], program))
                blocks.push_back(map_of(figures["grid"], program));
        blocks.push_back(cases_of(figures, "grid", "The maps in numbers"));
    }
    if (!figures["cases"].empty()) {
        blocks.push_back(cases_of(figures, "cases", "Cases that are hard on arithmetic"));
        blocks.push_back(costs_of(figures));
    }
    if (!figures["optics"].empty())
        blocks.push_back(optics_of(figures));
    return blocks;
}

} // namespace hard

Experiment hard_experiment() {
    return {"hard-cases",
            "Numerical stability",
            "wrong answers and leaks on extreme cases, and over scale, offset and aspect, beside "
            "Embree's",
            hard::runs,
            hard::figures,
            hard::blocks};
}

} // namespace ovc
