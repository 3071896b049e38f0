// SPDX-License-Identifier: Apache-2.0
// The section on claims has a row for each figure and each promise of README.md,
// docs/guide/performance.md and docs/benchmarks.md, which is measured here or held by a named test.
#include "host/report/experiments/claims.h"
#include "host/report/experiments/experiment_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

namespace ovc {

namespace claims_page {

constexpr const char* kBars = "bars";

ReportRun stats_run(const std::string& key, std::vector<std::string> words, double seconds) {
    words.insert(words.begin(), "render");
    words.insert(words.end(), {"--quiet", "--stats", "{}/stats.json", "-o", "{}/picture.png"});
    return {key, std::move(words), "stats.json", seconds};
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    const std::string mesh = !plan.scenes.empty() ? plan.scenes[0]
                             : !plan.mesh.empty() ? plan.mesh
                             : plan.quick         ? "sphere-7"
                                                  : "knot";
    ReportRun bars{kBars, {"bench", mesh, "--bars"}, "bars.json", plan.quick ? 75.0 : 240.0};
    if (plan.quick)
        bars.words.insert(bars.words.end(), {"--size", "256x256", "--repeats", "3"});
    if (!plan.scenes.empty())
        bars.words.push_back("--scene-alone");
    bars.words.insert(bars.words.end(), {"--json", "{}/bars.json"});
    std::vector<ReportRun> runs = {
        bars, {"grid", {"report", "--only", "grid", "--quick", "-o", "{}"}, "grid.json", 4}};
    if (!plan.scenes.empty())
        return runs;
    runs.push_back(stats_run("demo", {"plants", "--size", "1280x720", "--gpu-memory", "86M"}, 6));
    runs.push_back(stats_run("cores", {"glass", "--size", "1024x1024", "--mode", "batched"}, 3));
    for (const std::string mode : {"batched", "mixed"}) {
        std::vector<std::string> words{"dragonball", "--size", "512x512", "--mode", mode};
        // Both budgets are somewhat more than a third of their scene's pages.
        const std::vector<std::string> size =
            plan.quick ? std::vector<std::string>{"--model", "sphere-7", "--gpu-memory", "8M"}
                       : std::vector<std::string>{"--gpu-memory", "110M"};
        words.insert(words.end(), size.begin(), size.end());
        runs.push_back(stats_run("passes-" + mode, std::move(words), plan.quick ? 2 : 6));
    }
    return runs;
}

/// Returns the bar of the measured line of `overcast bench --bars` that the claim names, or else
/// the claim's own bar.
std::optional<ClaimBar> bar_of(const Claim& claim, const ClaimResults& results) {
    const Json& line = results.bar(claim.what);
    if (line.is_null() || line["measured"].is_null())
        return claim.bar;
    return ClaimBar{line["better"] == "less", line["at_least"]};
}

std::string verdict_of(const Claim& claim, const Json& value, const std::optional<ClaimBar>& bar) {
    if (!claim.measure)
        return "held elsewhere";
    if (value.is_null())
        return "not measured";
    if (!bar)
        return "no bar";
    const bool holds = bar->at_most ? value <= bar->value : value >= bar->value;
    return holds ? "holds" : "misses the bar";
}

Json row_of(const Claim& claim, const ClaimResults& results) {
    const Json value = claim.measure ? claim.measure(results) : Json(nullptr);
    const std::optional<ClaimBar> bar = bar_of(claim, results);
    const std::string document = std::filesystem::path(claim.document).stem();
    return {{"claim", claim.what},
            {"where", claim.heading.empty() ? document : document + ": " + claim.heading},
            {"says", claim.says},
            {"measured", value},
            {"better", !bar           ? ""
                       : bar->at_most ? "at most"
                                      : "at least"},
            {"bar", bar ? Json(bar->value) : Json(nullptr)},
            {"verdict", verdict_of(claim, value, bar)},
            {"held_by", claim.held_by}};
}

Json figures(std::span<const RawResult> results) {
    const ClaimResults measured(results);
    Json rows = Json::array();
    std::string mesh;
    for (const Claim& claim : claims())
        rows.push_back(row_of(claim, measured));
    for (const RawResult& raw : results)
        if (raw.run.key == kBars)
            mesh = std::filesystem::path(raw.run.words[1]).filename();
    const auto count = [&](const char* verdict) {
        return std::ranges::count(rows, verdict, [](const Json& row) { return row["verdict"]; });
    };
    return {{"rows", rows},
            {"held", count("holds")},
            {"failed", count("misses the bar")},
            {"mesh", mesh}};
}

/// Escapes the label of a tic for gnuplot, which reads it within single quotes and as a format.
std::string tic(const std::string& label) {
    std::string text;
    for (const char c : label)
        text += std::string(c == '%' || c == '\'' ? 2 : 1, c);
    return text;
}

/// Plots how far above its bar each line of `overcast bench --bars` is; 1 is at the bar. Bars of 0
/// are not drawn.
Plot reached_plot(const Json& figures) {
    std::string data = "# bar, times the bar\n", tics;
    int place = 0;
    for (const Json& row : figures["rows"]) {
        if (row["where"] != "benchmarks: The bars" || row["measured"].is_null() ||
            row["bar"].is_null() || row["bar"] == 0.0 || row["measured"] == 0.0)
            continue;
        const double ratio = row["measured"].get<double>() / row["bar"].get<double>();
        data += fmt::format("{} {:.4g}\n", place, row["better"] == "at least" ? ratio : 1 / ratio);
        tics += fmt::format("{}'{}' {}", place ? ", " : "", tic(row["claim"].get<std::string>()),
                            place);
        ++place;
    }
    return {"claims-reached",
            "Times the bar that is reached: from the dashed line on, a bar is met.", data,
            fmt::format("unset key\nset lmargin at screen 0.5\nset ytics ({}) font ',11'\nset "
                        "yrange [{}.7:-0.7]\n"
                        "set logscale x\nset xtics (0.5, 1, 2, 4)\n"
                        "set xlabel 'times the bar'\n"
                        "set arrow from 1,graph 0 to 1,graph 1 nohead ls 9\n"
                        "plot datafile using 2:1 with points ls 1\n",
                        tics, std::max(0, place - 1)),
            height_of_bars(place)};
}

std::vector<Block> blocks(const Json& figures) {
    Table table{"Claims, where they stand, and what is measured here",
                {"claim", "stands in", "what it says", "measured here", "asked for", "bar",
                 "verdict", "held by"},
                {}};
    for (size_t r = 0; r < figures["rows"].size(); ++r) {
        const Json& row = figures["rows"][r];
        const std::string at = fmt::format("/rows/{}", r);
        const auto words = [&](const char* key) { return Text{row[key].get<std::string>()}; };
        table.rows.push_back({words("claim"),
                              words("where"),
                              words("says"),
                              {number(figures, at + "/measured")},
                              words("better"),
                              {number(figures, at + "/bar")},
                              words("verdict"),
                              words("held_by")});
    }
    return {
        Text{"Of the claims that are measured here ", number(figures, "/held"),
             " reach their bar and ", number(figures, "/failed"),
             " miss it; the others have none, or are held by the tests that are named. The mesh "
             "of the bars is ",
             figures["mesh"].get<std::string>(),
             ". The documents' figures are of the scenes and machines that they name: ratios "
             "move with both, with the size of pictures, and with other work on the machine. "
             "What a bar asks is what the design asks; where it is missed, the documents say "
             "so and why."},
        reached_plot(figures), table};
}

} // namespace claims_page

Experiment claims_experiment() {
    return {"claims",
            "Claims",
            "a row for each claim of README.md, docs/guide/performance.md and docs/benchmarks.md, "
            "measured or held by a test",
            claims_page::runs,
            claims_page::figures,
            claims_page::blocks};
}

} // namespace ovc
