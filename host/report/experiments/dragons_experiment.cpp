// SPDX-License-Identifier: Apache-2.0
// Dragons measures scenes of more and more dragons, as table 4.2 and figures 4.5 and 4.6 of the
// thesis do.
#include "host/report/experiments/experiment_table.h"
#include "host/report/experiments/thesis_runs.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace ovc {

namespace dragons {

/// Table 4.2 of the thesis: MB of textures for 1 to 21 dragons.
constexpr std::array<double, 21> kReportedMegabytes = {68.3, 123, 177, 232, 286,  341,  396,
                                                       451,  506, 560, 616, 670,  725,  779,
                                                       834,  890, 944, 970, 1020, 1080, 1130};

constexpr std::string_view kScene = "dragons-";

std::vector<int> dragons_of(const ReportPlan& plan) {
    std::vector<int> dragons;
    for (const std::string& scene : plan.scenes)
        if (int n = 0;
            scene.starts_with(kScene) &&
            std::from_chars(scene.data() + kScene.size(), scene.data() + scene.size(), n).ec ==
                std::errc{} &&
            n > 0)
            dragons.push_back(n);
    if (!plan.scenes.empty())
        return dragons;
    return plan.quick ? std::vector{1, 5, 11} : std::vector{1, 3, 5, 8, 12, 16, 21};
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<ReportRun> runs;
    for (const int n : dragons_of(plan)) {
        FramesAsked asked{fmt::format("{}{}", kScene, n),
                          plan.quick ? "0:99:50" : "0:99:10",
                          plan.quick ? "192x192" : "512x512",
                          {}};
        const std::vector<std::string> model = model_words(plan, "sphere-5");
        for (const ThesisSystem& system : thesis_systems()) {
            asked.more = model;
            if (system.key == "product-budget") // as much memory as the thesis' GPU had
                asked.more.insert(asked.more.end(), {"--gpu-memory", plan.quick ? "12M" : "256M"});
            // The CPU KD-tree takes longest to build.
            const double seconds = plan.quick ? 2 : (system.key == "kdt" ? 7 : 2) * n;
            runs.push_back(frames_run(asked.scene, system, asked, seconds));
            // Like the thesis' single texture, ours has a maximum size.
            runs.back().may_refuse = system.key == "single";
        }
    }
    return runs;
}

int dragons_in(const RawResult& raw) {
    const std::string scene = split_run_key(raw.run.key).first;
    return std::stoi(scene.substr(kScene.size()));
}

/// Returns rows in the order of the runs, which come scene by scene.
Json rows_of(std::span<const RawResult> results) {
    Json rows = Json::array();
    for (const RawResult& raw : results) {
        const int n = dragons_in(raw);
        if (rows.empty() || rows.back()["dragons"] != n)
            rows.push_back(
                {{"dragons", n},
                 {"triangles", nullptr},
                 {"reported_mb", n <= 21 ? Json(kReportedMegabytes[size_t(n) - 1]) : Json(nullptr)},
                 {"single_mb", nullptr},
                 {"batched_mb", nullptr},
                 {"product-batched_mb", nullptr},
                 {"refused", Json::array()},
                 {"systems", Json::array()}});
        const std::string system = split_run_key(raw.run.key).second;
        Json& row = rows.back();
        if (raw.result.contains("refused")) {
            row["refused"].push_back(raw.result["refused"]);
            continue;
        }
        row["triangles"] = raw.result["triangles"];
        if (const std::string mb = system + "_mb"; row.contains(mb))
            row[mb] = 1e-6 * raw.result["level2_bytes"].get<double>();
        row["systems"].push_back(frames_of(system, raw.result));
    }
    return rows;
}

/// Returns the geometric mean of a ratio over all rows.
Json mean_ratio(const Json& rows, const char* mean, const char* a, const char* b) {
    double sum = 0, count = 0;
    for (const Json& row : rows)
        if (const Json ratio = ratio_of(row["systems"], mean, a, b); !ratio.is_null()) {
            sum += std::log(ratio.get<double>());
            ++count;
        }
    return count > 0 ? Json(std::exp(sum / count)) : Json(nullptr);
}

/// Returns the dragons of the last row that the system rendered, or null.
Json max_with(const Json& rows, const char* system) {
    Json most = nullptr;
    for (const Json& row : rows)
        if (find_system(row["systems"], system))
            most = row["dragons"];
    return most;
}

/// Returns the MB of the budget that the product ran in.
Json budget_megabytes(std::span<const RawResult> results) {
    for (const RawResult& raw : results)
        if (split_run_key(raw.run.key).second == "product-budget")
            return 1e-6 * raw.result["gpu_budget_bytes"].get<double>();
    return nullptr;
}

Json bytes_a_triangle(const Json& rows, const char* megabytes) {
    const Json& last = rows.back();
    if (last[megabytes].is_null() || last["triangles"].is_null())
        return nullptr;
    return 1e6 * last[megabytes].get<double>() / last["triangles"].get<double>();
}

Json figures(std::span<const RawResult> results) {
    const Json rows = rows_of(results);
    const std::string renderer = renderer_of(results);
    const char* cost = cost_by(renderer).mean;
    const std::vector<Finding> findings = {
        {"two-level, batched: times as fast as the CPU KD-tree", "2 to 5",
         mean_ratio(rows, cost, "kdt", "batched"),
         mean_ratio(rows, cost, "kdt", "product-batched")},
        {"GPU calls, mixed over batched", "about 0.5",
         mean_ratio(rows, "mean_calls", "mixed", "batched"),
         mean_ratio(rows, "mean_calls", "product-mixed", "product-batched")},
        {"time, mixed over batched", "below 1", mean_ratio(rows, cost, "mixed", "batched"),
         mean_ratio(rows, cost, "product-mixed", "product-batched")},
        {"bytes a triangle, the most dragons", "64 to 67", bytes_a_triangle(rows, "batched_mb"),
         bytes_a_triangle(rows, "product-batched_mb")},
        {"dragons in a single texture, at most", "4", max_with(rows, "single"), nullptr},
        {"dragons rendered without a wall, of those asked for here", "18", nullptr,
         max_with(rows, "product-budget")}};
    return {{"model", model_text(results[0].run)},
            {"renderer", renderer},
            {"budget_mb", budget_megabytes(results)},
            {"frames", rows.back()["systems"].empty()
                           ? Json(nullptr)
                           : Json(rows.back()["systems"][0]["frame"].size())},
            {"rows", rows},
            {"findings", findings_of(findings)}};
}

Json mean_of(const Json& row, std::string_view key, const char* mean) {
    const Json* one = find_system(row["systems"], key);
    return one ? (*one)[mean] : Json(nullptr);
}

Plot growth_plot(const Json& figures) {
    const FrameCost cost = cost_by(figures["renderer"]);
    std::string data, curves;
    int block = 0;
    for (const ThesisSystem& system : thesis_systems()) {
        std::string lines;
        for (const Json& row : figures["rows"])
            if (const Json seconds = mean_of(row, system.key, cost.mean); !seconds.is_null())
                lines +=
                    fmt::format("{} {:.6g}\n", row["dragons"].get<int>(), seconds.get<double>());
        if (lines.empty())
            continue;
        data += fmt::format("# {}: dragons, {}\n{}\n\n", system.name, cost.label, lines);
        curves += fmt::format("{}datafile index {} using 1:2 with linespoints ls {} title '{}'",
                              block ? ", " : "", block, style_of(system.key), system.name);
        ++block;
    }
    return {"dragons-time", "Figure 4.5 (a) of the thesis, here: time a frame against dragons.",
            data,
            fmt::format("set xlabel 'dragons'\nset ylabel '{}'\nset yrange [0:*]\n"
                        "set xtics 2\nplot {}\n",
                        cost.label, curves)};
}

Plot size_plot(const Json& figures) {
    std::string data = "# dragons, MB: reported, two-level as the thesis has it, product\n";
    for (const Json& row : figures["rows"]) {
        data += std::to_string(row["dragons"].get<int>());
        for (const char* mb : {"reported_mb", "batched_mb", "product-batched_mb"})
            data += row[mb].is_null() ? " NaN" : fmt::format(" {:.6g}", row[mb].get<double>());
        data += "\n";
    }
    return {"dragons-size",
            "Figure 4.5 (b) and table 4.2 of the thesis, here: MB on the GPU against dragons.",
            data,
            "set xlabel 'dragons'\nset ylabel 'MB'\nset yrange [0:*]\nset xtics 2\n"
            "plot datafile using 1:2 with linespoints ls 7 title 'the thesis reports', "
            "datafile using 1:3 with linespoints ls 3 title 'its two-level, here', "
            "datafile using 1:4 with linespoints ls 5 title 'the product'\n"};
}

Table growth_table(const Json& figures) {
    const FrameCost cost = cost_by(figures["renderer"]);
    Table table;
    table.caption = fmt::format("Table 4.2 of the thesis and ours; {} of each system", cost.label);
    table.header = {"dragons",           "triangles",          "MB, thesis reports",
                    "MB, its two-level", "MB, single texture", "MB, product"};
    for (const ThesisSystem& system : thesis_systems())
        table.header.push_back(std::string(system.name));
    for (size_t r = 0; r < figures["rows"].size(); ++r) {
        const std::string at = fmt::format("/rows/{}", r);
        table.rows.emplace_back();
        for (const char* key : {"dragons", "triangles", "reported_mb", "batched_mb", "single_mb",
                                "product-batched_mb"})
            table.rows.back().push_back({number(figures, fmt::format("{}/{}", at, key))});
        const Json& systems = figures["rows"][r]["systems"];
        for (const ThesisSystem& system : thesis_systems()) {
            const auto found = std::ranges::find_if(
                systems, [&](const Json& one) { return one["key"] == system.key; });
            table.rows.back().push_back(
                found == systems.end()
                    ? Text{"-"}
                    : Text{number(figures, fmt::format("{}/systems/{}/{}", at,
                                                       found - systems.begin(), cost.mean))});
        }
    }
    return table;
}

std::vector<Block> blocks(const Json& figures) {
    const size_t last = figures["rows"].size() - 1;
    const Json& systems = figures["rows"][last]["systems"];
    const FrameCost cost = cost_by(figures["renderer"]);
    const std::string of_the_last = fmt::format("/rows/{}/", last);
    std::vector<std::string_view> all, gpu;
    for (const ThesisSystem& system : thesis_systems()) {
        all.push_back(system.key);
        if (system.key != "kdt" && system.key != "single")
            gpu.push_back(system.key);
    }
    std::vector<Block> blocks = {
        Text{"Each scene is a mirroring plane with so many dragons on it, all triangles of their "
             "own; means of ",
             number(figures, "/frames"), " frames once round.", figures["model"].get<std::string>(),
             " The thesis' single texture ended at the size of its GPU's memory, and its two-level "
             "slowed down sharply where the driver's paging gave out. Here memory is a budget: all "
             "systems have what the device offers, but the product in a budget, which has ",
             number(figures, "/budget_mb"),
             " MB for pages, rays and hits, and moves pages as it needs them."},
        Text{renderer_text(figures)},
        findings_table(figures),
        kdtree_text(figures, of_the_last + "systems"),
        mixed_text(figures, of_the_last + "systems"),
        growth_plot(figures),
        size_plot(figures),
        frames_plot("dragons-frames",
                    "Figure 4.6 (a) of the thesis, here: the most dragons, frame "
                    "by frame.",
                    systems, all, cost.list, cost.label),
        frames_plot("dragons-calls", "Figure 4.6 (b) of the thesis, here: GPU calls a frame.",
                    systems, gpu, "calls", "GPU calls"),
        growth_table(figures),
        systems_table(figures, of_the_last + "systems", "Means with the most dragons")};
    for (const Json& row : figures["rows"])
        for (const Json& refused : row["refused"])
            blocks.push_back(Text{"Single texture: ", refused.get<std::string>(), "."});
    return blocks;
}

} // namespace dragons

Experiment dragons_experiment() {
    return {"dragons",
            "The thesis: dragons",
            "table 4.2, figures 4.5 and 4.6 of the thesis: from 1 to 21 dragons, in each of its "
            "systems and ours",
            dragons::runs,
            dragons::figures,
            dragons::blocks};
}

} // namespace ovc
