// SPDX-License-Identifier: Apache-2.0
// Claims: a row for each figure and each promise of README.md and docs/benchmarks.md, measured here
// or held by a test that is named.
#include "host/bench/contender.h"
#include "host/report/experiment_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

namespace ovc {

namespace {

/// Contenders, and Embree's where there are any.
std::string with_embree(const std::string& contenders, const char* embree) {
    return has_embree() ? contenders + "," + embree : contenders;
}

ReportRun bench_run(const char* key, const std::string& scene, const ReportPlan& plan,
                    const std::vector<std::string>& more, double seconds) {
    ReportRun run{key, {"bench", scene}, "bench.json", seconds};
    run.words.insert(run.words.end(), more.begin(), more.end());
    run.words.insert(run.words.end(), {"--size", plan.quick ? "320x320" : "1024x1024", "--repeats",
                                       plan.quick ? "3" : "5", "--json", "{}/bench.json"});
    return run;
}

std::vector<ReportRun> runs(const ReportPlan& plan) {
    const std::string mesh = !plan.scenes.empty() ? plan.scenes[0]
                             : plan.mesh.empty()  ? "knot"
                                                  : plan.mesh;
    const bool quick = plan.quick;
    const std::vector<std::string> hard = {"--only",
                                           with_embree("certified-compute", "embree-high"),
                                           "--workloads", "primary,shadow,diffuse"};
    std::vector<ReportRun> runs = {
        bench_run("mesh", mesh, plan,
                  {"--only",
                   with_embree("certified-compute,fast-compute,cpu-float-kdtree",
                               "embree-medium,embree-robust"),
                   "--leaves", "auto,1,8,32,128", "--workloads", "primary,shadow,diffuse,frame"},
                  quick ? 30 : 150),
        {"grid", {"report", "--only", "grid", "--quick", "-o", "{}"}, "grid.json", 4}};
    if (!plan.scenes.empty())
        return runs;
    runs.push_back(bench_run("soup", quick ? "soup-50" : "soup-500", plan, hard, quick ? 5 : 60));
    runs.push_back(bench_run("plant", "powerplant-400000", plan, hard, quick ? 5 : 30));
    runs.push_back(
        bench_run("budget", quick ? "plants-10" : "dragons-10", plan,
                  {"--only", "certified-compute", "--resident", "all,30%", "--workloads", "frame"},
                  quick ? 15 : 240));
    if (!plan.mesh.empty())
        runs.push_back({"programs",
                        {"bench", mesh, "--programs", "--json", "{}/programs.json"},
                        "programs.json",
                        60});
    return runs;
}

/// The results by the keys of their runs; what is not there is null.
class Measured {
public:
    explicit Measured(std::span<const RawResult> results) : results_(results) {}

    const Json& of(std::string_view key) const {
        static const Json nothing;
        for (const RawResult& raw : results_)
            if (raw.run.key == key)
                return raw.result;
        return nothing;
    }
    /// All scenes of all benches.
    std::vector<const Json*> scenes() const {
        std::vector<const Json*> scenes;
        for (const RawResult& raw : results_)
            if (raw.result.contains("scenes"))
                for (const Json& scene : raw.result["scenes"])
                    scenes.push_back(&scene);
        return scenes;
    }

private:
    std::span<const RawResult> results_;
};

const Json* named(const Json& bench, const char* list, const char* key, const std::string& name,
                  const std::string& workload = "") {
    if (!bench.contains("scenes"))
        return nullptr;
    for (const Json& one : bench["scenes"].at(0)[list])
        if (one[key].get<std::string>().starts_with(name) &&
            (workload.empty() || one["workload"] == workload))
            return &one;
    return nullptr;
}

Json quotient(const Json* a, const char* a_key, const Json* b, const char* b_key) {
    if (!a || !b || (*a)[a_key].is_null() || (*b)[b_key].is_null())
        return nullptr;
    return (*a)[a_key]["median"].get<double>() / (*b)[b_key]["median"].get<double>();
}

using Measure = std::function<Json(const Measured&)>;

/// The peer's time over that of our kernel: above 1 is faster than the peer.
Measure kernel_against(const char* run, const char* peer, const char* workload) {
    return [=](const Measured& measured) {
        const Json& bench = measured.of(run);
        const Json* theirs = named(bench, "measurements", "contender", peer, workload);
        const Json* ours = named(bench, "measurements", "contender", "certified-compute", workload);
        const bool kernel = theirs && !(*theirs)["kernel_seconds"].is_null();
        return quotient(theirs, kernel ? "kernel_seconds" : "cpu_seconds", ours, "kernel_seconds");
    };
}

Measure leaves_against_one(const char* leaves) {
    return [=](const Measured& measured) {
        const Json& bench = measured.of("mesh");
        const auto of = [&](const char* label) {
            return named(bench, "measurements", "contender",
                         fmt::format("certified-compute, {}", label), "diffuse");
        };
        return quotient(of(leaves), "kernel_seconds", of("1 leaf"), "kernel_seconds");
    };
}

Json certified_to_fast(const Measured& measured) {
    const Json* ours =
        named(measured.of("mesh"), "measurements", "contender", "certified-compute", "frame");
    return ours ? (*ours)["call_time_to_fast"] : Json(nullptr);
}

Json decided_in_doubles(const Measured& measured) {
    const Json* ours =
        named(measured.of("mesh"), "measurements", "contender", "certified-compute", "frame");
    return ours ? Json(100 * (*ours)["flagged"].get<double>() / (*ours)["rays"].get<double>())
                : Json(nullptr);
}

Json budget_time(const Measured& measured) {
    const Json& bench = measured.of("budget");
    const auto of = [&](const char* label) {
        return named(bench, "measurements", "contender",
                     fmt::format("certified-compute, budget {}", label), "frame");
    };
    return quotient(of("30%"), "cpu_seconds", of("all"), "cpu_seconds");
}

/// Pictures under the budget that are not those of all memory: by their checksums.
Json budget_pictures(const Measured& measured) {
    const Json& bench = measured.of("budget");
    if (!bench.contains("scenes"))
        return nullptr;
    const Json& all = bench["scenes"].at(0)["measurements"];
    return int(std::ranges::count_if(
        all, [&](const Json& one) { return one["checksum"] != all[0]["checksum"]; }));
}

Json build_to_embree(const Measured& measured) {
    const Json* ours = named(measured.of("mesh"), "contenders", "label", "certified-compute");
    return ours ? (*ours)["build_time_to_embree"] : Json(nullptr);
}

Measure bytes_a_triangle(const char* run) {
    return [=](const Measured& measured) {
        const Json* ours = named(measured.of(run), "contenders", "label", "certified-compute");
        return ours ? (*ours)["bytes_a_triangle"] : Json(nullptr);
    };
}

/// Certified answers unlike those of double precision, in all runs together.
Json wrong_answers(const Measured& measured) {
    double wrong = 0;
    for (const Json* scene : measured.scenes())
        for (const Json& one : (*scene)["measurements"])
            if (one["contender"].get<std::string>().starts_with("certified"))
                wrong += one["differ"].get<double>();
    if (const Json& grid = measured.of("grid"); grid.contains("cases"))
        for (const Json& one : grid["cases"])
            wrong += one["certified"]["wrong"].get<double>();
    return wrong;
}

Json leaks(const Measured& measured) {
    const Json& grid = measured.of("grid");
    if (!grid.contains("cases"))
        return nullptr;
    double leaks = 0;
    for (const Json& one : grid["cases"])
        leaks += one["certified"]["leaks"].get<double>();
    return leaks;
}

/// The most that GPU memory in use was over the budget, of all contenders; 0: never.
Json over_the_budget(const Measured& measured) {
    double over = 0;
    for (const Json* scene : measured.scenes())
        for (const Json& one : (*scene)["contenders"])
            if (!one["gpu_peak_bytes"].is_null() && !one["gpu_budget_bytes"].is_null())
                over = std::max(over, one["gpu_peak_bytes"].get<double>() -
                                          one["gpu_budget_bytes"].get<double>());
    return over;
}

Measure program_against(const char* program) {
    return [=](const Measured& measured) -> Json {
        const Json& bench = measured.of("programs");
        if (bench.contains("programs"))
            for (const Json& one : bench["programs"])
                if (one["name"] == program)
                    return one["overcast_times_as_fast"];
        return nullptr;
    };
}

enum class Better { AtLeast, AtMost };

struct Claim {
    std::string what;
    const char* where;
    const char* reported;
    Measure measure;       // empty: held by `test`
    const char* test = ""; // for ctest -R
    Better better = Better::AtLeast;
    double bar = 0;
};

constexpr const char* kReadme = "README";
constexpr const char* kBars = "benchmarks: the bars";

std::vector<Claim> claims() {
    std::vector<Claim> claims = {
        {"certified answers unlike double precision", kReadme, "0", wrong_answers, "",
         Better::AtMost, 0},
        {"double precision as exact arithmetic has it",
         kReadme,
         "bit for bit",
         {},
         "Stability.TheReferenceIsExact"},
        {"Embree's robust mode beside exact arithmetic",
         kReadme,
         "differs on 4 and 27",
         {},
         "EmbreeParity"},
        {"the same whatever budget, leaves, kernel, driver",
         kReadme,
         "the same bits",
         {},
         "Invariance"},
        {"leaks of closed meshes", kBars, "0", leaks, "", Better::AtMost, 0},
        {"peak GPU bytes over the budget", kReadme, "never", over_the_budget, "", Better::AtMost,
         0},
        {"bad input: a sentence and exit code 1", kReadme, "always", {}, "CommandLine.BadInput"},
        {"frame, certified against fast: times the time", kReadme, "1.09", certified_to_fast, "",
         Better::AtMost, 1.25},
        {"frame: % of answers decided in doubles", kReadme, "0.09", decided_in_doubles, "",
         Better::AtMost, 1},
        {"pictures under a budget unlike those without", kReadme, "the same", budget_pictures, "",
         Better::AtMost, 0},
        {"overcast render against povray, file to PNG", kBars, "7.05", program_against("povray"),
         "", Better::AtLeast, 6},
        {"overcast render against tachyon, file to PNG", kBars, "2.80", program_against("tachyon"),
         "", Better::AtLeast, 2}};
    struct Kernel {
        const char *run, *peer, *scene;
        const char* reported[3];
        double bars[3];
    };
    static constexpr Kernel kernels[] = {
        {"mesh", "embree-robust", "mesh", {"0.95", "0.94", "0.83"}, {1, 1, 0.9}},
        {"mesh", "cpu-float-kdtree", "mesh", {"2.57", "2.78", "3.50"}, {2.5, 4, 4}},
        {"soup", "embree-high", "soup", {"0.71", "0.63", "0.83"}, {0.7, 0.7, 0.7}},
        {"plant", "embree-high", "power plant", {"0.52", "0.38", "0.36"}, {0.7, 0.7, 0.7}}};
    constexpr const char* workloads[] = {"primary", "shadow", "diffuse"};
    for (const Kernel& kernel : kernels)
        for (int w = 0; w < 3; ++w)
            claims.push_back(
                {fmt::format("kernel against {}, {}: {}", kernel.peer, kernel.scene, workloads[w]),
                 kBars, kernel.reported[w], kernel_against(kernel.run, kernel.peer, workloads[w]),
                 "", Better::AtLeast, kernel.bars[w]});
    const std::vector<Claim> more = {
        {"8 leaves against one, diffuse", kBars, "0.99", leaves_against_one("8 leaves"), "",
         Better::AtMost, 1.05},
        {"32 leaves against one, diffuse", kBars, "1.02", leaves_against_one("32 leaves"), "",
         Better::AtMost, 1.10},
        {"128 leaves against one, diffuse", kBars, "1.01", leaves_against_one("128 leaves"), "",
         Better::AtMost, 1.25},
        {"budget of 30 % against all resident, frame", kBars, "1.83", budget_time, "",
         Better::AtMost, 1.5},
        {"build of both levels against embree-medium", kBars, "0.85", build_to_embree, "",
         Better::AtMost, 2},
        {"level-2 bytes a triangle, mesh", kBars, "46", bytes_a_triangle("mesh"), "",
         Better::AtMost, 52},
        {"level-2 bytes a triangle, soup", kBars, "89", bytes_a_triangle("soup"), "",
         Better::AtMost, 96},
        {"import: peak memory over the soup's", kBars, "1.41", {}, "MemoryOfImport"},
        {"import: binary PLY, MB a CPU second", kBars, "553", {}, "overcast bench MESH --bars"},
        {"the plan, against what is made", "benchmarks: the plan", "within 10 %", {}, "Plan"},
        {"triangles that are there twice",
         "benchmarks: twins",
         "at most 1.5 times the time",
         {},
         "python3 host/bench/doubles.py"},
        {"single rays against the CPU tree's own",
         "benchmarks: single rays",
         "0.94 to 1.12",
         {},
         "SingleRays"},
        {"cost as work grows", "benchmarks: as work grows", "exponents", {}, "the section scale"},
        {"mixed passes over batched",
         "benchmarks: the budget",
         "at most 0.7 under a budget",
         {},
         "the sections of the thesis"}};
    claims.insert(claims.end(), more.begin(), more.end());
    return claims;
}

std::string verdict_of(const Claim& claim, const Json& value) {
    if (!claim.measure)
        return "held elsewhere";
    if (value.is_null())
        return "not measured";
    const double measured = value;
    const bool holds =
        claim.better == Better::AtLeast ? measured >= claim.bar : measured <= claim.bar;
    return holds ? "holds" : "misses the bar";
}

Json figures(std::span<const RawResult> results) {
    const Measured measured(results);
    Json rows = Json::array();
    size_t held = 0, failed = 0;
    for (const Claim& claim : claims()) {
        const Json value = claim.measure ? claim.measure(measured) : Json(nullptr);
        const std::string verdict = verdict_of(claim, value);
        held += verdict == "holds";
        failed += verdict == "misses the bar";
        rows.push_back({{"claim", claim.what},
                        {"where", claim.where},
                        {"reported", claim.reported},
                        {"measured", value},
                        {"better", !claim.measure                    ? ""
                                   : claim.better == Better::AtLeast ? "at least"
                                                                     : "at most"},
                        {"bar", claim.measure ? Json(claim.bar) : Json(nullptr)},
                        {"verdict", verdict},
                        {"held_by", claim.test}});
    }
    Json scenes = Json::array();
    for (const Json* scene : measured.scenes())
        scenes.push_back((*scene)["scene"]);
    return {{"rows", rows}, {"held", held}, {"failed", failed}, {"scenes", scenes}};
}

/// gnuplot takes labels of tics for formats: a percent sign is written twice.
std::string tic(const std::string& label) {
    std::string text;
    for (const char c : label)
        text += c == '%' ? std::string("%%") : std::string(1, c);
    return text;
}

/// How far above its bar a measurement is; 1: at the bar. Bars of 0 are not drawn.
Plot reached_plot(const Json& figures) {
    std::string data = "# bar, times the bar\n", tics;
    int place = 0;
    for (const Json& row : figures["rows"]) {
        if (row["measured"].is_null() || row["bar"] == 0.0 || row["measured"] == 0.0)
            continue;
        const double ratio = row["measured"].get<double>() / row["bar"].get<double>();
        data += fmt::format("{} {:.4g}\n", place, row["better"] == "at least" ? ratio : 1 / ratio);
        tics += fmt::format("{}'{}' {}", place ? ", " : "", tic(row["claim"].get<std::string>()),
                            place);
        ++place;
    }
    return {"claims-reached",
            "Times the bar that is reached: from the dashed line on, a bar is met.", data,
            fmt::format("unset key\nset ytics ({}) font ',10'\nset yrange [{}.7:-0.7]\n"
                        "set logscale x\nset xtics (0.25, 0.5, 1, 2, 4)\n"
                        "set xlabel 'times the bar'\n"
                        "set arrow from 1,graph 0 to 1,graph 1 nohead ls 9\n"
                        "plot datafile using 2:1 with points ls 1\n",
                        tics, std::max(0, place - 1))};
}

std::vector<Block> blocks(const Json& figures) {
    Table table{"Claims, where they stand, and what is measured here",
                {"claim", "stands in", "reported there", "measured here", "asked for", "bar",
                 "verdict", "held by"},
                {}};
    for (size_t r = 0; r < figures["rows"].size(); ++r) {
        const Json& row = figures["rows"][r];
        const std::string at = fmt::format("/rows/{}", r);
        const auto words = [&](const char* key) { return Text{row[key].get<std::string>()}; };
        table.rows.push_back({words("claim"),
                              words("where"),
                              words("reported"),
                              {number(figures, at + "/measured")},
                              words("better"),
                              {number(figures, at + "/bar")},
                              words("verdict"),
                              words("held_by")});
    }
    std::string scenes;
    for (const Json& scene : figures["scenes"])
        scenes += (scenes.empty() ? "" : ", ") + scene.get<std::string>();
    return {Text{"Of the claims that are measured here ", number(figures, "/held"),
                 " reach their bar and ", number(figures, "/failed"),
                 " miss it; the others are held by the tests that are named. Scenes: ", scenes,
                 ". The documents' figures are of the scenes and machines that they name: ratios "
                 "move with both, and with other work on the machine. What a bar asks is what the "
                 "design asks; where it is missed, the documents say so and why."},
            reached_plot(figures), table};
}

} // namespace

Experiment claims_experiment() {
    return {"claims",
            "Claims",
            "a row for each claim of README.md and docs/benchmarks.md, measured or held by a test",
            runs,
            figures,
            blocks};
}

} // namespace ovc
