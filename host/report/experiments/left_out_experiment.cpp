// SPDX-License-Identifier: Apache-2.0
// Measures what leaving out the unneeded parts of a rendering saves, by switching them back on.
#include "host/report/experiments/experiment_table.h"
#include "host/report/experiments/thesis_runs.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace left_out {

/// A part of the work that is left out unless it is asked for.
struct Switch {
    const char* key;
    const char* name;
    std::vector<std::string> without, with;
};

const std::vector<Switch>& switches() {
    static const std::vector<Switch> all = {
        {"shadows", "shadow rays", {"--no-shadows"}, {}},
        {"proofs", "proofs of answers", {"--precision", "fast"}, {}},
        {"leaves", "leaves of level 1", {"--leaves", "1"}, {"--leaves", "100"}},
        {"telling", "telling which pages are used", {}, {"--working-set"}},
        {"bounces", "reflection and refraction", {"--max-depth", "0"}, {}}};
    return all;
}

/// Disables both caches of compiled kernels, the library's and Mesa's.
const std::vector<std::string> kNothingCompiled = {"OVC_KERNEL_CACHE=off",
                                                   "MESA_SHADER_CACHE_DISABLE=true"};
constexpr std::string_view kCold = "-cold";

std::string key_of(const std::string& scene, const Switch& one, bool with, bool cold, int repeat) {
    std::string name;
    for (const char c : scene.substr(scene.find_last_of('/') + 1))
        name += std::isalnum(static_cast<unsigned char>(c)) ? c : '-';
    return fmt::format("{}--{}-{}{}-{}", name, one.key, with ? "with" : "without",
                       cold ? kCold : "", repeat);
}

/// Returns a run of one side of a switch. cold: the picture has so few rays that compiling takes
/// the time.
ReportRun run_of(const std::string& scene, const Switch& one, bool with, bool cold, int repeat,
                 bool quick) {
    ReportRun run{key_of(scene, one, with, cold, repeat),
                  {"render", scene, "--size",
                   cold    ? "16x16"
                   : quick ? "256x256"
                           : "1024x1024"},
                  "stats.json",
                  quick ? 0.6 : 1.5};
    if (cold)
        run.variables = kNothingCompiled;
    const std::vector<std::string>& words = with ? one.with : one.without;
    run.words.insert(run.words.end(), words.begin(), words.end());
    run.words.insert(run.words.end(),
                     {"--quiet", "--stats", "{}/stats.json", "-o", "{}/picture.png"});
    return run;
}

/// Cold runs are not repeated, because the time of compiling varies little.
int repeats_of(const ReportPlan& plan, bool cold) {
    return cold ? 1 : plan.quick ? 3 : 5;
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    std::vector<std::string> scenes = plan.scenes;
    if (scenes.empty()) {
        scenes = {plan.quick ? "sphere-7" : "knot", "mirrors"};
        if (!plan.quick)
            scenes.insert(scenes.end(), {"glass", "city", "plants-10", "powerplant-400000"});
        if (!plan.mesh.empty())
            scenes.insert(scenes.begin(), plan.mesh);
    }
    std::vector<ReportRun> runs;
    for (const std::string& scene : scenes)
        for (const Switch& one : switches())
            for (const bool cold : {false, true})
                for (int repeat = 0; repeat < repeats_of(plan, cold); ++repeat)
                    for (const bool with : {false, true}) // both sides take turns
                        runs.push_back(run_of(scene, one, with, cold, repeat, plan.quick));
    return runs;
}

double rays_of(const Json& stats) {
    double sum = 0;
    for (const Json& of_a_kind : stats["rays"])
        sum += of_a_kind.get<double>();
    return sum;
}

/// The statistics that the runs of one side of a switch wrote.
struct Side {
    std::vector<const Json*> warm, cold;
};

double cpu_ms(const Json& stats) {
    return 1e3 * stats["time"]["cpu"].get<double>();
}

/// Returns medians over the repeats.
Json side_of(const Side& side) {
    const auto median = [](const std::vector<const Json*>& stats, const auto& value) -> Json {
        std::vector<double> values;
        for (const Json* one : stats)
            values.push_back(value(*one));
        if (values.empty())
            return nullptr;
        std::ranges::nth_element(values, values.begin() + std::ptrdiff_t(values.size() / 2));
        return values[values.size() / 2];
    };
    const auto of = [&](const auto& value) { return median(side.warm, value); };
    return {
        {"cpu_ms", of(cpu_ms)},
        {"compile_ms", median(side.cold, cpu_ms)},
        {"kernel_ms", of([](const Json& s) { return 1e3 * s["time"]["kernel"].get<double>(); })},
        {"pages_kb", of([](const Json& s) { return 1e-3 * s["level2_bytes"].get<double>(); })},
        {"gpu_kb", of([](const Json& s) { return 1e-3 * s["gpu_peak_bytes"].get<double>(); })},
        {"rays", of(rays_of)}};
}

Json row_of(const std::string& scene, const Switch& one, const Side& without, const Side& with) {
    Json row = {{"scene", scene},
                {"what", one.name},
                {"without", side_of(without)},
                {"with", side_of(with)}};
    const double off = row["without"]["cpu_ms"], on = row["with"]["cpu_ms"];
    row["saved_percent"] = on > 0 ? Json(100 * (on - off) / on) : Json(nullptr);
    return row;
}

/// Returns what the scene's first run says that it left out, where that has bytes.
Json told_of(const std::string& scene, const Json& stats) {
    Json told = Json::array();
    for (const Json& one : stats["left_out"])
        if (one["bytes"].get<double>() > 0)
            told.push_back({{"scene", scene},
                            {"what", one["what"]},
                            {"kb", 1e-3 * one["bytes"].get<double>()},
                            {"pages_kb", 1e-3 * stats["level2_bytes"].get<double>()}});
    return told;
}

Json figures(std::span<const RawResult> results) {
    Json rows = Json::array(), told = Json::array();
    for (size_t i = 0; i < results.size();) {
        const auto [scene, first] = split_run_key(results[i].run.key);
        const std::string what = first.substr(0, first.find('-'));
        if (i == 0 || split_run_key(results[i - 1].run.key).first != scene)
            for (const Json& one : told_of(scene, results[i].result))
                told.push_back(one);
        Side without, with;
        for (; i < results.size(); ++i) {
            const auto [other, key] = split_run_key(results[i].run.key);
            if (other != scene || !key.starts_with(what + "-"))
                break;
            Side& side = key.starts_with(what + "-without") ? without : with;
            (key.find(kCold) == std::string::npos ? side.warm : side.cold)
                .push_back(&results[i].result);
        }
        const auto found = std::ranges::find(switches(), what, &Switch::key);
        if (found != switches().end() && !without.warm.empty() && !with.warm.empty())
            rows.push_back(row_of(scene, *found, without, with));
    }
    return {{"rows", rows}, {"told", told}};
}

Plot saved_plot(const Json& figures) {
    std::string data = "# bar, saved %, scene and what\n", tics;
    size_t bar = 0;
    for (const Json& row : figures["rows"]) {
        if (row["saved_percent"].is_null())
            continue;
        data += fmt::format("{} {:.4g}\n", bar, row["saved_percent"].get<double>());
        tics += fmt::format("{}'{}: {}' {}", bar ? ", " : "", row["scene"].get<std::string>(),
                            row["what"].get<std::string>(), bar);
        ++bar;
    }
    return {"left-out-saved",
            "What leaving it out saves of the CPU seconds of tracing and shading.", data,
            fmt::format("unset key\nset style fill solid 0.8\nset lmargin at screen 0.42\nset "
                        "ytics ({}) font ',11'\n"
                        "set yrange [{}:-0.5]\nset xlabel 'saved, % of the time with it'\n"
                        "plot datafile using ($2/2):1:($2/2):(0.35) with boxxyerror ls 1\n",
                        tics, double(bar) - 0.5),
            height_of_bars(bar)};
}

Table rows_table(const Json& figures) {
    Table table;
    table.caption = "Each with and without, medians of runs in turn";
    table.header = {"scene",
                    "what",
                    "CPU ms without",
                    "with",
                    "saved %",
                    "compiling ms without",
                    "with",
                    "kernel ms without",
                    "with",
                    "GPU kB without",
                    "with",
                    "pages kB without",
                    "with",
                    "rays without",
                    "with"};
    for (size_t r = 0; r < figures["rows"].size(); ++r) {
        const std::string at = fmt::format("/rows/{}", r);
        const auto side = [&](const char* which, const char* key) {
            return Text{number(figures, fmt::format("{}/{}/{}", at, which, key))};
        };
        std::vector<Text> row = {{figures["rows"][r]["scene"].get<std::string>()},
                                 {figures["rows"][r]["what"].get<std::string>()},
                                 side("without", "cpu_ms"),
                                 side("with", "cpu_ms"),
                                 {number(figures, at + "/saved_percent")}};
        for (const char* key : {"compile_ms", "kernel_ms", "gpu_kb", "pages_kb", "rays"})
            for (const char* which : {"without", "with"})
                row.push_back(side(which, key));
        table.rows.push_back(std::move(row));
    }
    return table;
}

Table told_table(const Json& figures) {
    Table table;
    table.caption =
        "Bytes that scenes' files have and that are not stored, beside the bytes of all pages, as "
        "the program tells";
    table.header = {"scene", "left out", "kB", "pages kB"};
    for (size_t i = 0; i < figures["told"].size(); ++i) {
        const std::string at = fmt::format("/told/{}", i);
        table.rows.push_back({{figures["told"][i]["scene"].get<std::string>()},
                              {figures["told"][i]["what"].get<std::string>()},
                              {number(figures, at + "/kb")},
                              {number(figures, at + "/pages_kb")}});
    }
    return table;
}

std::vector<Block> blocks(const Json& figures) {
    std::vector<Block> blocks = {
        Text{"A scene, and what is asked of it, decide what is stored, moved, compiled and "
             "traced. Each of these is switched on and off on the same scene, in turn; the "
             "time is of all threads while rays are traced and shaded. Where a scene has no "
             "mirrors, reflection and refraction cost nothing even when they are allowed: "
             "the difference is noise. Compiling is the CPU time of a picture of few rays with "
             "nothing kept that was compiled before; other pictures find their kernels on disk."},
        saved_plot(figures), rows_table(figures)};
    if (!figures["told"].empty())
        blocks.push_back(told_table(figures));
    return blocks;
}

} // namespace left_out

Experiment left_out_experiment() {
    return {"left-out",
            "Left out",
            "what renderings have no need of, and what that saves, by switching it on and off",
            left_out::runs,
            left_out::figures,
            left_out::blocks};
}

} // namespace ovc
