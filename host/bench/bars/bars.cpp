// SPDX-License-Identifier: Apache-2.0
// Computes the bars from results. The numbers promised stand here and in docs/benchmarks.md.
#include "host/bench/bars/bars.h"

#include "host/bench/ratios/ratios.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace ovc {

std::string_view verdict(const Bar& bar) {
    if (!bar.measured)
        return "skipped";
    if (bar.is_too_noisy())
        return "too noisy";
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

std::span<const double> call_turns(const Measurement& m) {
    return m.seconds;
}

/// Returns a line for each set of rays: the peer's seconds, of which turns() are taken, divided by
/// ours.
template <class Turns>
std::vector<Bar> against(const BenchResult& r, const std::string& what, std::string_view peer,
                         const PromiseOfSets& promises, const char* part, Turns&& turns) {
    std::vector<Bar> bars;
    for (size_t i = 0; i < kRaySetNames.size(); ++i) {
        Bar bar{fmt::format("{} against {}, {}: {}", part, peer, what, kRaySetNames[i]),
                Better::More,
                promises[i].at_least,
                promises[i].aim,
                {},
                "times as fast"};
        const Measurement* const ours = find(r, "certified", kRaySetNames[i]);
        if (const Measurement* const theirs = find(r, peer, kRaySetNames[i]); ours && theirs)
            bar.take(paired_ratio(turns(*theirs), turns(*ours)));
        if (!bar.measured)
            bar.note = fmt::format("{} did not take part", peer);
        bars.push_back(bar);
    }
    return bars;
}

/// Returns the sums over the three sets of rays, by turns, of an entrant.
std::vector<double> summed_turns(const BenchResult& r, size_t entrant) {
    std::vector<double> sums;
    for (const Measurement& m : r.measurements) {
        if (m.entrant != entrant)
            continue;
        sums.resize(std::max(sums.size(), m.seconds.size()));
        for (size_t i = 0; i < m.seconds.size(); ++i)
            sums[i] += m.seconds[i];
    }
    return sums;
}

/// Returns the line with the certified call seconds a ray of one workload divided by those of
/// another.
Bar a_ray(const BenchResult& mesh, const std::string& over, const std::string& under, Bar bar) {
    bar.note = "times as long, a ray";
    const auto seconds_of = [&](const std::string& workload) {
        std::vector<double> each;
        if (const Measurement* measured = find(mesh, "certified", workload))
            for (const double seconds : measured->seconds)
                each.push_back(seconds / double(measured->rays));
        return each;
    };
    const std::vector<double> dividend = seconds_of(over), divisor = seconds_of(under);
    if (!dividend.empty() && !divisor.empty())
        bar.take(paired_ratio(dividend, divisor));
    return bar;
}

} // namespace

std::vector<Bar> kernel_bars(const BenchResult& scene, const std::string& what,
                             std::string_view peer, const PromiseOfSets& promises) {
    return against(scene, what, peer, promises, "kernel", kernel_turns);
}

std::vector<Bar> call_bars(const BenchResult& scene, const std::string& what, std::string_view peer,
                           const PromiseOfSets& promises) {
    return against(scene, what, peer, promises, "call", call_turns);
}

Bar certify_bar(const BenchResult& mesh) {
    Bar frame{"frame, certified against fast", Better::Less, 1.25, 1.1, {}, "times as long"};
    const Measurement* certified = find(mesh, "certified", "frame");
    if (const Measurement* fast = find(mesh, "fast", "frame"); certified && fast)
        frame.take(paired_ratio(certified->seconds, fast->seconds));
    return frame;
}

Bar edges_bar(const BenchResult& mesh) {
    return a_ray(
        mesh, "edges", "primary",
        {"call of rays at sides and corners against primary, mesh", Better::Less, 4, 2, {}, {}});
}

std::vector<Bar> small_calls_bars(const BenchResult& mesh) {
    std::vector<Bar> bars;
    for (const std::string set : kRaySetNames)
        bars.push_back(
            a_ray(mesh, set + kSmall, set,
                  {fmt::format("calls of {} rays against one, mesh: {}", kSmallCallRays, set),
                   Better::Less,
                   1.3,
                   1.1,
                   {},
                   {}}));
    return bars;
}

std::vector<Bar> leaves_bars(const BenchResult& sweep) {
    constexpr std::array<Promise, 3> promises = {{{1.05, 1.03}, {1.10, 1.03}, {1.25, 1.03}}};
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
            bar.take(paired_ratio(summed_turns(sweep, i), summed_turns(sweep, 0)));
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
            if (m.entrant != i || !sweep.complete)
                continue;
            const auto first =
                std::ranges::find_if(sweep.measurements, [&](const Measurement& other) {
                    return other.entrant == 0 && other.workload == m.workload;
                });
            const auto ratio = paired_ratio(kernel_turns(m), kernel_turns(*first));
            if (!ratio || ratio->median <= bar.measured.value_or(0))
                continue;
            bar.take(ratio);
            bar.note =
                fmt::format("times as long, {} rays, the worst of three sets; {} leaves made",
                            sweep.workloads[m.workload], entrant.built.leaves);
        }
        bars.push_back(bar);
    }
    return bars;
}

Bar budget_bar(const BenchResult& sweep) {
    Bar bar{"budget of 30 % against all resident, dragons-10, frame with shadows",
            Better::Less,
            1.25,
            1.1,
            {},
            "times as long"};
    if (sweep.measurements.size() == 2) {
        const Measurement& part = sweep.measurements[1];
        bar.take(paired_ratio(part.seconds, sweep.measurements[0].seconds));
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
    const std::pair<const char*, Promise> peers[] = {{"povray", {8, 10}}, {"tachyon", {3, 4}}};
    for (const auto& [peer, promise] : peers) {
        Bar bar{fmt::format("overcast render against {}, from file to PNG", peer),
                Better::More,
                promise.at_least,
                promise.aim,
                {},
                "times as fast"};
        bar.take(times_as_fast(programs, peer));
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
