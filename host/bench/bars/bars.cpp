// SPDX-License-Identifier: Apache-2.0
// Computes the bars from results. The numbers promised stand here and in docs/benchmarks.md.
#include "host/bench/bars/bars.h"

#include "host/bench/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ovc {

bool Bar::passed() const {
    return measured && (better == Better::More ? *measured >= at_least : *measured <= at_least);
}

std::string_view verdict(const Bar& bar) {
    if (!bar.measured)
        return "skipped";
    return bar.passed() ? "passed" : "failed";
}

Bar skipped_bar(std::string what, std::string why) {
    Bar bar;
    bar.what = std::move(what);
    bar.note = std::move(why);
    return bar;
}

namespace {

/// Returns null where the contender did not take part or the run was stopped before its turn.
const Measurement* find(const BenchResult& r, std::string_view contender,
                        std::string_view workload) {
    for (const Measurement& m : r.measurements)
        if (r.entrants[m.entrant].contender.name == contender &&
            r.workloads[m.workload] == workload)
            return &m;
    return nullptr;
}

constexpr std::array<const char*, 3> kRaySets = {"primary", "shadow", "diffuse"};

struct Promise {
    double at_least, aim;
};

Bar against(const BenchResult& r, const char* workload, const std::string& what,
            std::string_view peer, Promise promise) {
    Bar bar{fmt::format("kernel against {}, {}: {}", peer, what, workload),
            Better::More,
            promise.at_least,
            promise.aim,
            {},
            "times as fast"};
    if (const Measurement* ours = find(r, "certified", workload))
        bar.measured = kernel_speed_to(r, *ours, peer);
    if (!bar.measured)
        bar.note = fmt::format("{} did not take part", peer);
    return bar;
}

} // namespace

std::vector<Bar> kernel_bars(const BenchResult& mesh) {
    constexpr std::array<Promise, 3> robust = {{{1.0, 1.2}, {1.0, 1.2}, {0.9, 1.1}}};
    constexpr std::array<Promise, 3> kdt = {{{2.5, 3}, {4, 5}, {4, 6}}};
    std::vector<Bar> bars;
    for (size_t i = 0; i < kRaySets.size(); ++i)
        bars.push_back(against(mesh, kRaySets[i], "mesh", "embree-robust", robust[i]));
    for (size_t i = 0; i < kRaySets.size(); ++i)
        bars.push_back(against(mesh, kRaySets[i], "mesh", "cpu-float-kdtree", kdt[i]));
    Bar frame{"frame, certified against fast", Better::Less, 1.25, 1.1, {}, "times as long"};
    const Measurement* certified = find(mesh, "certified", "frame");
    if (const Measurement* fast = find(mesh, "fast", "frame"); certified && fast)
        frame.measured = call_seconds(*certified) / call_seconds(*fast);
    bars.push_back(frame);
    return bars;
}

std::vector<Bar> high_quality_bars(const BenchResult& scene, const std::string& what) {
    std::vector<Bar> bars;
    for (const char* set : kRaySets)
        bars.push_back(against(scene, set, what, "embree-high", {0.7, 1.0}));
    return bars;
}

std::vector<Bar> leaves_bars(const BenchResult& sweep) {
    constexpr std::array<Promise, 3> promises = {{{1.05, 1.03}, {1.10, 1.03}, {1.25, 1.03}}};
    std::vector<double> seconds(sweep.entrants.size(), 0);
    for (const Measurement& m : sweep.measurements)
        seconds[m.entrant] += call_seconds(m);
    std::vector<Bar> bars;
    for (size_t i = 1; i < sweep.entrants.size() && i <= promises.size(); ++i) {
        const BenchEntrant& entrant = sweep.entrants[i];
        Bar bar{
            fmt::format("{} leaves against one, all resident", entrant.contender.leaves.words),
            Better::Less,
            promises[i - 1].at_least,
            promises[i - 1].aim,
            {},
            fmt::format("times as long, three sets of rays; {} leaves made", entrant.built.leaves)};
        if (sweep.complete)
            bar.measured = seconds[i] / seconds[0];
        bars.push_back(bar);
    }
    return bars;
}

std::vector<Bar> leaves_of_scene_bars(const BenchResult& sweep, const std::string& what) {
    constexpr std::array<Promise, 2> promises = {{{1.08, 1.03}, {1.15, 1.03}}};
    std::vector<Bar> bars;
    for (size_t i = 1; i < sweep.entrants.size() && i <= promises.size(); ++i) {
        const BenchEntrant& entrant = sweep.entrants[i];
        Bar bar{fmt::format("kernel in {} leaves against one, {}", entrant.contender.leaves.words,
                            what),
                Better::Less,
                promises[i - 1].at_least,
                promises[i - 1].aim,
                {},
                ""};
        for (const Measurement& m : sweep.measurements) {
            const std::optional<double> ratio = ratios_of(sweep, m).kernel_time_to_first;
            if (m.entrant != i || !sweep.complete || !ratio || *ratio <= bar.measured.value_or(0))
                continue;
            bar.measured = ratio;
            bar.note =
                fmt::format("times as long, {} rays, the worst of three sets; {} leaves made",
                            sweep.workloads[m.workload], entrant.built.leaves);
        }
        bars.push_back(bar);
    }
    return bars;
}

std::vector<Bar> default_leaves_bars(const BenchResult& scene, const std::string& what) {
    constexpr std::array<Promise, 3> robust = {{{1.1, 1.3}, {1.0, 1.3}, {1.0, 1.3}}};
    std::vector<Bar> bars;
    for (size_t i = 0; i < kRaySets.size(); ++i)
        bars.push_back(against(scene, kRaySets[i], what, "embree-robust", robust[i]));
    return bars;
}

Bar budget_bar(const BenchResult& sweep) {
    Bar bar{"budget of 30 % against all resident, dragons-10, frame with shadows",
            Better::Less,
            1.5,
            1.15,
            {},
            "times as long"};
    if (sweep.measurements.size() == 2) {
        const Measurement& part = sweep.measurements[1];
        bar.measured = call_seconds(part) / call_seconds(sweep.measurements[0]);
        bar.note = fmt::format("times as long, {} passes, {:.0f} MB moved in", part.passes,
                               1e-6 * double(part.bytes_in));
    }
    return bar;
}

Bar bytes_bar(const BenchResult& scene, const std::string& what, double at_least, double aim) {
    Bar bar{"level-2 bytes a triangle, " + what, Better::Less, at_least, aim, {}, ""};
    for (const BenchEntrant& entrant : scene.entrants)
        if (entrant.contender.name == "certified")
            bar.measured = bytes_a_triangle(scene, entrant);
    return bar;
}

Bar peak_bar(std::span<const BenchResult> results) {
    Bar bar{"peak GPU bytes over the budget", Better::Less, 0, 0, {}, ""};
    for (const BenchResult& r : results)
        for (const BenchEntrant& entrant : r.entrants) {
            const ovc_statistics& s = entrant.after;
            if (!entrant.contender.on_gpu() || s.gpu_peak_bytes == 0)
                continue;
            const double over =
                std::max(0.0, double(s.gpu_peak_bytes) - double(s.gpu_budget_bytes));
            bar.measured = std::max(bar.measured.value_or(0), over);
        }
    bar.note = "the worst of all scenes and budgets above";
    return bar;
}

std::vector<Bar> program_bars(const ProgramsResult& programs) {
    std::vector<Bar> bars;
    const std::pair<const char*, Promise> peers[] = {{"povray", {6, 8}}, {"tachyon", {2, 3}}};
    for (const auto& [peer, promise] : peers) {
        Bar bar{fmt::format("overcast render against {}, from file to PNG", peer),
                Better::More,
                promise.at_least,
                promise.aim,
                times_as_fast(programs, peer),
                "times as fast"};
        if (!bar.measured)
            bar.note = fmt::format("{} is not installed", peer);
        bars.push_back(bar);
    }
    return bars;
}

std::vector<Bar> import_bars(std::span<const std::pair<std::string, ImportCost>> files) {
    Bar peak{"import: peak memory over the soup's", Better::Less, 1.5, 1.1, {}, ""};
    Bar speed{"import: binary PLY, MB a CPU second", Better::More, 150, 500, {}, ""};
    for (const auto& [name, cost] : files)
        if (cost.peak_to_soup() > peak.measured.value_or(0)) {
            peak.measured = cost.peak_to_soup();
            peak.note = fmt::format("the worst of {} files: {}", files.size(), name);
        }
    if (!files.empty())
        speed.measured = files.back().second.megabytes_per_second();
    return {peak, speed};
}

} // namespace ovc
