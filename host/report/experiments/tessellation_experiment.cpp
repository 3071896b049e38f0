// SPDX-License-Identifier: Apache-2.0
// Measures what finer triangles cost, against the exact spheres, cones and tori that they
// approximate, and against povray's picture of these.
#include "host/report/experiments/experiment_table.h"
#include "host/report/page/frontier.h"
#include "host/report/page/frontier_plot.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace tessellation {

constexpr const char* kDefault = "the reader's own";

std::vector<ReportRun> runs(const ReportPlan& plan) {
    return {{"shapes",
             {"bench", "--pictures", "tolerance", "--size", plan.quick ? "256x256" : "1024x1024",
              "--repeats", plan.quick ? "3" : "5", "--json", "{}/shapes.json"},
             "shapes.json",
             plan.quick ? 8.0 : 90.0}};
}

/// Returns a choice's triangles, costs, and how far its hits are from the exact shapes.
Json shape_choice(const Json& row, double rays) {
    double largest = 0;
    for (const Json& off : row["largest_distance"])
        largest = std::max(largest, off.get<double>());
    const double import = row["import_seconds"], build = row["build_seconds"],
                 call = row["call_seconds"];
    return {{"choice", row["choice"]},
            {"tolerance", row["tolerance"]},
            {"triangles", row["triangles"]},
            {"pages_mb", megabytes(row["page_bytes"])},
            {"import_ms", 1e3 * import},
            {"build_ms", 1e3 * build},
            {"call_ms", 1e3 * call},
            {"all_ms", 1e3 * (import + build + call)},
            {"largest_distance", row["largest_distance"]},
            {"largest_of_all", largest},
            {"rms_distance", row["rms_distance"]},
            {"t_error_rms", row["t_error_rms"]},
            {"t_error_largest", row["t_error_largest"]},
            {"unlike_per_million", 1e6 * row["unlike"].get<double>() / rays}};
}

Json picture_choice(const Json& name, const Json& picture) {
    return {{"choice", name},
            {"seconds", picture["seconds"]},
            {"cpu_seconds", picture["cpu_seconds"]},
            {"rmse", picture["rmse"]},
            {"host_peak_mb", megabytes(picture["host_peak_bytes"])},
            {"gpu_peak_mb", megabytes(picture["gpu_peak_bytes"])},
            {"moved_mb", megabytes(picture["bytes_in"])}};
}

Json figures(std::span<const RawResult> results) {
    const Json& bench = results[0].result;
    const double rays = bench["rays"].get<double>();
    Json choices = Json::array(), pictures = Json::array();
    for (const Json& row : bench["rows"]) {
        choices.push_back(shape_choice(row, rays));
        if (!row["picture"].is_null())
            pictures.push_back(picture_choice(row["choice"], row["picture"]));
    }
    const auto is_povray = [](const Json& c) { return c["choice"] == "povray"; };
    judge_choices(
        choices, "all_ms",
        [](const Json& c) {
            return std::vector<double>{c["largest_of_all"].get<double>(),
                                       c["t_error_rms"].get<double>()};
        },
        is_povray);
    if (!bench["povray"].is_null())
        pictures.push_back(picture_choice("povray", bench["povray"]));
    judge_choices(
        pictures, "seconds",
        [](const Json& c) { return std::vector<double>{c["rmse"].get<double>()}; }, is_povray);
    return {{"shapes", bench["shapes"]}, {"size", bench["size"]},
            {"rays", bench["rays"]},     {"same_time_percent", 100 * kSameTime},
            {"choices", choices},        {"pictures", pictures}};
}

PlotSeries::Point point_of(const Json& choice, const char* x, const Json& error) {
    return {choice[x].get<double>(), error.get<double>(), choice["choice"].get<std::string>()};
}

/// Plots a line for each shape, from few triangles to many.
Plot distance_plot(const Json& figures) {
    std::string data = "# triangles, largest distance in radii\n", lines;
    int style = 0;
    for (const Json& shape : figures["shapes"]) {
        const std::string name = shape;
        std::vector<std::pair<double, double>> points;
        for (const Json& c : figures["choices"])
            points.emplace_back(c["triangles"].get<double>(),
                                c["largest_distance"][name].get<double>());
        std::ranges::sort(points);
        for (const auto& [triangles, off] : points)
            data += fmt::format("{:.6g} {:.6g}\n", triangles, off);
        data += "\n\n";
        lines += fmt::format("{}datafile index {} using 1:2 with linespoints ls {} title '{}'",
                             style ? ", " : "", style, style + 1, name);
        ++style;
    }
    return {"tessellation-distance",
            "The largest distance of a hit point from the exact shape, in radii of its widest "
            "circle, against triangles of all shapes.",
            data,
            "set logscale xy\nset format xy '10^{%L}'\nset xlabel 'triangles'\n"
            "set ylabel 'largest distance, radii'\nplot " +
                lines + "\n"};
}

/// Plots the choices' error against time; the default has its own mark.
Plot choices_plot(const std::string& name, const std::string& caption, const Json& choices,
                  const char* x, const char* error, const std::string& x_label,
                  const std::string& y_label) {
    std::vector<PlotSeries> series = {{"a tolerance", {}}, {"the default", {}}, {"povray", {}}};
    for (const Json& c : choices)
        series[c["choice"] == kDefault   ? 1
               : c["choice"] == "povray" ? 2
                                         : 0]
            .points.push_back(point_of(c, x, c[error]));
    return frontier_plot(name, caption, series, x_label, y_label);
}

Table shapes_table(const Json& figures) {
    Table table;
    table.caption = "Triangles, bytes and time against the exact shapes; distances in radii of a "
                    "shape's widest circle; the default is marked";
    table.header = {"choice",  "triangles",    "pages MB",     "import ms",        "build ms",
                    "call ms", "RMS distance", "t error, RMS", "t error, largest", "unlike / 1e6"};
    for (const Json& shape : figures["shapes"])
        table.header.push_back("off the " + shape.get<std::string>() + ", largest");
    table.header.push_back("dominated by, its time");
    for (size_t i = 0; i < figures["choices"].size(); ++i) {
        const std::string at = fmt::format("/choices/{}", i);
        const std::string name = figures["choices"][i]["choice"];
        if (name == kDefault)
            table.marked = i;
        std::vector<Text> row = {{name}};
        for (const char* key :
             {"triangles", "pages_mb", "import_ms", "build_ms", "call_ms", "rms_distance",
              "t_error_rms", "t_error_largest", "unlike_per_million"})
            row.push_back({number(figures, at + "/" + key)});
        for (const Json& shape : figures["shapes"])
            row.push_back({number(figures, at + "/largest_distance/" + shape.get<std::string>())});
        row.push_back(frontier_cell(figures, at));
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table pictures_table(const Json& figures) {
    Table table;
    table.caption = "Whole programs, from the scene's file to a picture; the default is marked";
    table.header = {"choice",  "s",           "CPU s",    "RMSE",
                    "peak MB", "GPU peak MB", "moved MB", "dominated by, its time"};
    for (size_t i = 0; i < figures["pictures"].size(); ++i) {
        const std::string at = fmt::format("/pictures/{}", i);
        const std::string name = figures["pictures"][i]["choice"];
        if (name == kDefault)
            table.marked = i;
        table.rows.push_back({{name}});
        for (const char* key :
             {"seconds", "cpu_seconds", "rmse", "host_peak_mb", "gpu_peak_mb", "moved_mb"})
            table.rows.back().push_back({number(figures, at + "/" + key)});
        table.rows.back().push_back(frontier_cell(figures, at));
    }
    return table;
}

void add_pictures(const Json& figures, std::vector<Block>& blocks) {
    if (figures["pictures"].empty()) {
        blocks.push_back(Text{"povray is not installed: no picture is compared with its own."});
        return;
    }
    blocks.push_back(Text{"The same file drawn by overcast and by povray, which knows the shapes "
                          "themselves: ",
                          number(figures, "/size"),
                          " pixels a side, one ray through the middle of each. The error is the "
                          "root mean square over pixels and colors of linear light, white being ",
                          "one. povray's own picture is what is right, and so has none."});
    blocks.push_back(default_text(figures, "/pictures", "Pictures: ", kDefault, "seconds", "s"));
    blocks.push_back(choices_plot("tessellation-pictures",
                                  "Error of the picture against time of the whole program. "
                                  "\"none\" is no error at all.",
                                  figures["pictures"], "seconds", "rmse", "s, from file to picture",
                                  "RMSE of the picture"));
    blocks.push_back(pictures_table(figures));
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {
        Text{"Round shapes are cut into triangles, no farther off than a tolerance in radii. A "
             "sphere, a cone and a torus are read at one tolerance after the other; ",
             number(figures, "/rays"),
             " camera rays are answered by the triangles, certified, and by the exact shapes in "
             "double precision. The default is what the "
             "reader of .pov scenes chooses by itself. Unlike are rays that hit the one and miss "
             "the other, at "
             "silhouettes; the largest error of t is of rays that graze. A choice is dominated "
             "when another has no larger error and is faster by more than ",
             number(figures, "/same_time_percent"),
             " %, or has a smaller one and is not slower; time is of reading, building and the "
             "call together."},
        default_text(figures, "/choices", "Rays: ", kDefault, "all_ms", "ms"),
        distance_plot(figures),
        choices_plot("tessellation-t", "RMS relative error of t against time.", figures["choices"],
                     "all_ms", "t_error_rms", "ms, reading, building and answering",
                     "RMS relative error of t"),
        shapes_table(figures)};
    add_pictures(figures, blocks);
    return blocks;
}

} // namespace tessellation

Experiment tessellation_experiment() {
    return {"tessellation",
            "Tessellation",
            "what finer triangles cost, against exact spheres, cones and tori, and against "
            "povray's picture",
            tessellation::runs,
            tessellation::figures,
            tessellation::blocks};
}

} // namespace ovc
