// SPDX-License-Identifier: Apache-2.0
// Dragonball measures what the size of leaves costs, as figures 4.7 to 4.9 of the thesis do.
#include "host/report/experiments/experiment_table.h"
#include "host/report/experiments/thesis_runs.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace dragonball {

constexpr std::string_view kScene = "dragonball";
constexpr std::string_view kLeafSystems[] = {"batched", "mixed", "product-batched"};
/// The number of leaves that figure 4.8 has.
constexpr const char* kFew = "3";

std::vector<const char*> leaf_choices(bool quick) {
    if (quick)
        return {"2", "3", "8", "30", "120"};
    return {"2", "3", "4", "6", "9", "13", "20", "30", "50", "80", "130", "220", "400"};
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    if (!plan.scenes.empty() && std::ranges::find(plan.scenes, kScene) == plan.scenes.end())
        return {};
    FramesAsked asked{std::string(kScene),
                      plan.quick ? "0:99:50" : "0:99:20",
                      plan.quick ? "192x192" : "512x512",
                      {}};
    const std::vector<std::string> model = model_words(plan, "sphere-7");
    std::vector<ReportRun> runs;
    for (const char* leaves : leaf_choices(plan.quick))
        for (const std::string_view system : kLeafSystems) {
            asked.more = model;
            asked.more.insert(asked.more.end(), {"--leaves", leaves});
            runs.push_back(frames_run(fmt::format("leaves-{}", leaves), thesis_system(system),
                                      asked, plan.quick ? 2 : 20));
        }
    if (!plan.quick)
        asked.frames = "0:99:5";
    for (const std::string_view system : {"kdt", "batched", "mixed", "product-batched"}) {
        asked.more = model;
        if (system != "kdt")
            asked.more.insert(asked.more.end(), {"--leaves", kFew});
        runs.push_back(frames_run("few", thesis_system(system), asked, plan.quick ? 2 : 40));
    }
    return runs;
}

/// Returns a row for each partition; "leaves" is the number that was made.
Json rows_of(std::span<const RawResult> results) {
    Json rows = Json::array();
    std::string partition;
    for (const RawResult& raw : results) {
        const auto [key, system] = split_run_key(raw.run.key);
        if (key == "few")
            continue;
        if (key != partition) {
            partition = key;
            const double leaves = raw.result["leaves"];
            rows.push_back(
                {{"leaves", leaves},
                 {"average_mb", 1e-6 * raw.result["level2_bytes"].get<double>() / leaves},
                 {"systems", Json::array()}});
        }
        rows.back()["systems"].push_back(frames_of(system, raw.result));
    }
    return rows;
}

/// Returns for one system the number of leaves at which it is fastest, the range within 5 % of
/// that, and the cost of a further GPU call between the min and max number of leaves. Missing
/// values are null.
Json best_of(const Json& rows, std::string_view system, const char* cost) {
    constexpr double near = 1.05;
    Json best = {{"key", system},      {"name", thesis_system(system).name},
                 {"leaves", nullptr},  {"near_from", nullptr},
                 {"near_to", nullptr}, {"call_ms", nullptr}};
    std::vector<std::pair<double, const Json*>> points; // leaves, and the system's object there
    for (const Json& row : rows)
        if (const Json* one = find_system(row["systems"], system))
            points.emplace_back(row["leaves"], one);
    if (points.empty())
        return best;
    const auto of = [&](const auto& point, const char* mean) {
        return (*point.second)[mean].template get<double>();
    };
    const auto least =
        std::ranges::min_element(points, {}, [&](const auto& point) { return of(point, cost); });
    best["leaves"] = least->first;
    for (const auto& point : points)
        if (of(point, cost) <= near * of(*least, cost)) {
            if (best["near_from"].is_null())
                best["near_from"] = point.first;
            best["near_to"] = point.first;
        }
    const auto more = [&](const char* mean) {
        return of(points.back(), mean) - of(points.front(), mean);
    };
    if (more("mean_calls") != 0)
        best["call_ms"] = 1e3 * more(cost) / more("mean_calls");
    return best;
}

Json figures(std::span<const RawResult> results) {
    const Json rows = rows_of(results);
    Json few = Json::array();
    for (const RawResult& raw : results)
        if (const auto [key, system] = split_run_key(raw.run.key); key == "few")
            few.push_back(frames_of(system, raw.result));
    const std::string renderer = renderer_of(results);
    const char* cost = cost_by(renderer).mean;
    Json best = Json::array();
    for (const std::string_view system : kLeafSystems)
        best.push_back(best_of(rows, system, cost));
    const std::vector<Finding> findings = {
        {"leaves with which batched is fastest", "2, the fewest", best[0]["leaves"],
         best[2]["leaves"]},
        {"leaves with which mixed is fastest", "2, the fewest", best[1]["leaves"], nullptr},
        {"two-level, batched: times as fast as the CPU KD-tree", "about 3",
         ratio_of(few, cost, "kdt", "batched"), ratio_of(few, cost, "kdt", "product-batched")},
        {"GPU calls, mixed over batched", "about 0.5",
         ratio_of(few, "mean_calls", "mixed", "batched"), nullptr},
        {"time, mixed over batched", "slightly below 1", ratio_of(few, cost, "mixed", "batched"),
         nullptr}};
    return {{"model", model_text(results[0].run)},
            {"renderer", renderer},
            {"triangles", results[0].result["triangles"]},
            {"findings", findings_of(findings)},
            {"best", best},
            {"rows", rows},
            {"few", few}};
}

Plot leaf_plot(const Json& figures) {
    const FrameCost cost = cost_by(figures["renderer"]);
    std::string data, curves;
    int block = 0;
    for (const std::string_view key : kLeafSystems) {
        std::string lines;
        for (const Json& row : figures["rows"])
            if (const Json* one = find_system(row["systems"], key))
                lines += fmt::format("{} {:.6g}\n", row["leaves"].get<double>(),
                                     (*one)[cost.mean].get<double>());
        data += fmt::format("# {}: leaves, {}\n{}\n\n", key, cost.label, lines);
        curves += fmt::format("{}datafile index {} using 1:2 with linespoints ls {} title '{}'",
                              block ? ", " : "", block, style_of(key), thesis_system(key).name);
        ++block;
    }
    return {"dragonball-leaves", "Figure 4.7 (b) of the thesis, here: time a frame against leaves.",
            data,
            fmt::format("set logscale x\nset xlabel 'leaves of level 1'\nset ylabel '{}'\n"
                        "set yrange [0:*]\nplot {}\n",
                        cost.label, curves)};
}

Plot size_plot(const Json& figures) {
    std::string data = "# leaves, average MB of a page\n";
    for (const Json& row : figures["rows"])
        data += fmt::format("{} {:.6g}\n", row["leaves"].get<double>(),
                            row["average_mb"].get<double>());
    return {"dragonball-size",
            "Figure 4.7 (a) of the thesis, here: the average page against leaves.", data,
            "set logscale xy\nset xlabel 'leaves of level 1'\nset ylabel 'MB a page'\n"
            "plot datafile using 1:2 with linespoints ls 1 title 'average page'\n"};
}

Table leaf_table(const Json& figures) {
    const FrameCost cost = cost_by(figures["renderer"]);
    Table table;
    table.caption = "Leaves, and what they cost";
    table.header = {"leaves", "MB a page"};
    for (const std::string_view key : kLeafSystems)
        for (const char* what : {cost.label, "calls"})
            table.header.push_back(fmt::format("{}: {}", thesis_system(key).name, what));
    for (size_t r = 0; r < figures["rows"].size(); ++r) {
        const std::string at = fmt::format("/rows/{}", r);
        table.rows.push_back(
            {{number(figures, at + "/leaves")}, {number(figures, at + "/average_mb")}});
        const Json& systems = figures["rows"][r]["systems"];
        for (const std::string_view key : kLeafSystems) {
            const auto found =
                std::ranges::find_if(systems, [&](const Json& one) { return one["key"] == key; });
            for (const char* mean : {cost.mean, "mean_calls"})
                table.rows.back().push_back(
                    found == systems.end()
                        ? Text{"-"}
                        : Text{number(figures, fmt::format("{}/systems/{}/{}", at,
                                                           found - systems.begin(), mean))});
        }
    }
    return table;
}

/// Says from measurements which numbers of leaves are fastest, and why.
Text leaves_text(const Json& figures) {
    Text text = {"Within a twentieth of its best, by leaves:"};
    for (size_t i = 0; i < figures["best"].size(); ++i) {
        const std::string at = fmt::format("/best/{}", i);
        text.emplace_back(fmt::format("{} {}, from ", i ? ";" : "",
                                      figures["best"][i]["name"].get<std::string>()));
        text.push_back(number(figures, at + "/near_from"));
        text.emplace_back(" to ");
        text.push_back(number(figures, at + "/near_to"));
    }
    for (Piece piece :
         {Piece(". Between the fewest leaves and the most, a further GPU call of the thesis' "
                "batched costs "),
          number(figures, "/best/0/call_ms"), Piece(" ms and of its mixed "),
          number(figures, "/best/1/call_ms"),
          Piece(" ms, while what is moved stays the same: calls are what many leaves cost, as the "
                "thesis found, and batched makes most of them. Pages are moved once, a copy within "
                "one memory, so that few leaves gain nothing there. The product walks the upper "
                "level within the kernel: its calls do not grow with the leaves.")})
        text.push_back(std::move(piece));
    return text;
}

std::vector<Block> blocks(const Json& figures) {
    const FrameCost cost = cost_by(figures["renderer"]);
    return {
        Text{"A dragon of ", number(figures, "/triangles"),
             " triangles with the rest of its scene, mirrors, glass and waves.",
             figures["model"].get<std::string>(),
             " Leaves are those that the thesis' system made. The thesis "
             "expected the best size of leaves somewhere in the middle, and found the fewest "
             "leaves fastest, since a call cost more than moving a large page."},
        Text{renderer_text(figures)},
        findings_table(figures),
        leaves_text(figures),
        kdtree_text(figures, "/few"),
        mixed_text(figures, "/few"),
        leaf_plot(figures),
        size_plot(figures),
        frames_plot(
            "dragonball-time", "Figure 4.8 of the thesis, here: few leaves, with the CPU KD-tree.",
            figures["few"], {"kdt", "batched", "mixed", "product-batched"}, cost.list, cost.label),
        frames_plot("dragonball-calls",
                    "Figure 4.9 of the thesis, here: GPU calls a frame, few leaves.",
                    figures["few"], {"batched", "mixed", "product-batched"}, "calls", "GPU calls"),
        leaf_table(figures),
        systems_table(figures, "/few", "Few leaves: means of the frames")};
}

} // namespace dragonball

Experiment dragonball_experiment() {
    return {"dragonball",
            "The thesis: dragonball",
            "figures 4.7 to 4.9 of the thesis: leaves of level 1 from 2 to 400, and frame by frame",
            dragonball::runs,
            dragonball::figures,
            dragonball::blocks};
}

} // namespace ovc
