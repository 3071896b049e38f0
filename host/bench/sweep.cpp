// SPDX-License-Identifier: Apache-2.0
// Runs a sweep as benches whose scenes, rays or contenders grow, and fits a line to logarithms.
#include "host/bench/sweep.h"

#include "host/arguments/memory_size.h"
#include "host/bench/ratios/ratios.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>

namespace ovc {

namespace {

constexpr std::array<uint32_t, 5> kSides = {32, 100, 316, 1000, 3162}; // 1e3 to 1e7 pixels
constexpr std::array<uint32_t, 7> kLeaves = {1, 3, 10, 30, 100, 300, 1000};
constexpr std::array<uint32_t, 6> kPercents = {5, 10, 20, 30, 50, 100};
constexpr uint32_t kFirstSphere = 4, kLastSphere = 10; // 20 x 4^N triangles
constexpr std::array<uint32_t, 6> kInstances = {1, 10, 100, 1000, 10'000, 70'000};

const Contender kCertified{.name = "certified", .kind = ContenderKind::TwoLevel};

std::vector<Contender> with_robust() {
    std::vector<Contender> contenders = {kCertified};
    if (make_embree_backend(Soup{}, EmbreeMode::Robust))
        contenders.push_back(
            {.name = "embree-robust", .kind = ContenderKind::Embree, .embree = EmbreeMode::Robust});
    return contenders;
}

SceneBench bench_of(const BenchJob& job, std::string scene, Asked asked,
                    std::vector<Contender> contenders) {
    SceneBench bench;
    bench.scene = std::move(scene);
    bench.asked = std::move(asked);
    bench.repeats = job.repeats;
    bench.contenders = std::move(contenders);
    bench.device = job.device;
    bench.first_is_reference = true;
    return bench;
}

Error nothing_within(const BenchJob& job, uint64_t smallest) {
    return Error{fmt::format("--most {} leaves no row; the first has {}", job.most, smallest)};
}

constexpr uint64_t sphere_triangles(uint32_t n) {
    return uint64_t(20) << 2 * n;
}

/// Returns a row for each workload, which is named after its rays, and a column for each contender.
Result<Sweep> over_rays(const BenchJob& job, const BenchSurroundings& around) {
    Asked asked{.size = job.size, .ray_sets = false, .frame = false};
    for (const uint32_t side : kSides)
        if (uint64_t(side) * side <= job.most)
            asked.primary_sides.push_back(side);
    if (asked.primary_sides.empty())
        return nothing_within(job, uint64_t(kSides[0]) * kSides[0]);
    const Result<BenchResult> r =
        bench_scene(bench_of(job, job.scenes[0], asked, with_robust()), around);
    if (!r)
        return r.error();
    Sweep sweep{r->scene, "rays", {}, {}, r->complete};
    for (const BenchEntrant& entrant : r->entrants)
        sweep.columns.push_back(entrant.contender.label() + ": call s");
    for (size_t w = 0; w < r->workloads.size(); ++w)
        sweep.rows.push_back({0, std::vector<std::optional<double>>(sweep.columns.size())});
    for (const Measurement& m : r->measurements) {
        sweep.rows[m.workload].x = double(m.rays);
        sweep.rows[m.workload].values[m.entrant] = call_seconds(m);
    }
    return sweep;
}

/// Returns a row for each entrant. Its columns are the build, the calls of each workload, and the
/// passes and bytes of the last workload.
Sweep by_entrant(const BenchResult& r, std::string over,
                 const std::function<double(const BenchEntrant&)>& x) {
    Sweep sweep{r.scene, std::move(over), {"build s"}, {}, r.complete};
    for (const std::string& workload : r.workloads)
        sweep.columns.push_back(workload + ": call s");
    sweep.columns.insert(sweep.columns.end(), {"passes", "MB moved in"});
    for (const BenchEntrant& entrant : r.entrants) {
        sweep.rows.push_back(
            {x(entrant), std::vector<std::optional<double>>(sweep.columns.size())});
        sweep.rows.back().values[0] = entrant.build_seconds();
    }
    for (const Measurement& m : r.measurements) {
        std::vector<std::optional<double>>& values = sweep.rows[m.entrant].values;
        values[1 + m.workload] = call_seconds(m);
        const size_t passes = values.size() - 2; // the last workload overwrites the others' passes
        values[passes] = double(m.passes);
        values[passes + 1] = 1e-6 * double(m.bytes_in);
    }
    return sweep;
}

Result<Sweep> over_leaves(const BenchJob& job, const BenchSurroundings& around) {
    std::vector<Contender> contenders;
    for (const uint32_t leaves : kLeaves) {
        if (leaves > job.most)
            break;
        contenders.push_back(kCertified);
        contenders.back().leaves = {leaves, std::to_string(leaves)};
    }
    const Result<BenchResult> r =
        bench_scene(bench_of(job, job.scenes[0], {.size = job.size}, contenders), around);
    if (!r)
        return r.error();
    return by_entrant(*r, "leaves", [](const BenchEntrant& e) { return double(e.built.leaves); });
}

Result<Sweep> over_budget(const BenchJob& job, const BenchSurroundings& around) {
    std::vector<Contender> contenders;
    for (const uint32_t percent : kPercents) {
        contenders.push_back(kCertified);
        contenders.back().budget = {{}, percent / 100.0, fmt::format("{}%", percent)};
    }
    const Result<BenchResult> r =
        bench_scene(bench_of(job, job.scenes[0], {.size = job.size}, contenders), around);
    if (!r)
        return r.error();
    return by_entrant(*r, "budget %",
                      [](const BenchEntrant& e) { return 100 * e.contender.budget.pages_share; });
}

/// A scene of a sweep that takes no scene.
struct Step {
    std::string scene;
    uint64_t x;
};

/// Returns a row for each scene whose x is no more than the job's.
Result<Sweep> over_scenes(const BenchJob& job, const BenchSurroundings& around, Sweep sweep,
                          std::span<const Step> steps) {
    sweep.columns = {"making s", "build s", "bytes a triangle", "primary: call s"};
    Asked asked{.size = job.size, .ray_sets = false, .frame = false};
    asked.primary_sides = {job.size.width};
    if (steps.front().x > job.most)
        return nothing_within(job, steps.front().x);
    for (const Step& step : steps) {
        if (step.x > job.most || around.stop())
            break;
        const Result<BenchResult> r =
            bench_scene(bench_of(job, step.scene, asked, {kCertified}), around);
        if (!r)
            return r.error();
        if (r->measurements.empty())
            break; // the run was stopped
        const BenchEntrant& entrant = r->entrants[0];
        sweep.rows.push_back({double(step.x),
                              {r->seconds_import, entrant.build_seconds(),
                               bytes_a_triangle(*r, entrant), call_seconds(r->measurements[0])}});
    }
    sweep.complete = !around.stop();
    return sweep;
}

Result<Sweep> over_triangles(const BenchJob& job, const BenchSurroundings& around) {
    std::vector<Step> spheres;
    for (uint32_t n = kFirstSphere; n <= kLastSphere; ++n)
        spheres.push_back({fmt::format("sphere-{}", n), sphere_triangles(n)});
    return over_scenes(job, around, {"sphere-N", "triangles", {}, {}, true}, spheres);
}

Result<Sweep> over_instances(const BenchJob& job, const BenchSurroundings& around) {
    std::vector<Step> fractals;
    for (const uint32_t n : kInstances)
        fractals.push_back({fmt::format("fractal-{}", n), n});
    return over_scenes(job, around, {"fractal-N", "instances", {}, {}, true}, fractals);
}

} // namespace

Result<Sweep> run_sweep(const BenchJob& job, const BenchSurroundings& around) {
    switch (job.sweep) {
    case SweepOver::Rays:
        return over_rays(job, around);
    case SweepOver::Triangles:
        return over_triangles(job, around);
    case SweepOver::Instances:
        return over_instances(job, around);
    case SweepOver::Leaves:
        return over_leaves(job, around);
    case SweepOver::Budget:
        break;
    }
    return over_budget(job, around);
}

std::optional<double> fitted_exponent(const Sweep& sweep, size_t column) {
    std::vector<std::pair<double, double>> points;
    for (const SweepRow& row : sweep.rows) {
        assert(column < row.values.size());
        if (row.x > 0 && row.values[column].value_or(0) > 0)
            points.emplace_back(std::log(row.x), std::log(*row.values[column]));
    }
    if (points.size() < 2)
        return {};
    double x = 0, y = 0, xx = 0, xy = 0;
    for (const auto& [px, py] : points) {
        x += px / double(points.size());
        y += py / double(points.size());
    }
    for (const auto& [px, py] : points) {
        xx += (px - x) * (px - x);
        xy += (px - x) * (py - y);
    }
    return xx > 0 ? std::optional(xy / xx) : std::nullopt;
}

std::string sweep_table(const Sweep& sweep) {
    const auto shown = [](std::optional<double> value) {
        return value ? fmt::format("{:.4g}", *value) : std::string("-");
    };
    std::vector<TextRow> rows = {{sweep.over}};
    rows[0].insert(rows[0].end(), sweep.columns.begin(), sweep.columns.end());
    for (const SweepRow& row : sweep.rows) {
        rows.push_back({human_count(uint64_t(row.x + 0.5))});
        for (const std::optional<double>& value : row.values)
            rows.back().push_back(shown(value));
    }
    rows.push_back({"exponent"});
    for (size_t column = 0; column < sweep.columns.size(); ++column) {
        const std::optional<double> k = fitted_exponent(sweep, column);
        rows.back().push_back(k ? fmt::format("{:.2f}", *k) : "-");
    }
    return fmt::format("{}, certified\n\n{}{}", sweep.scene, markdown_table(rows),
                       sweep.complete ? ""
                                      : "\nInterrupted: these are the calls that were done.\n");
}

std::string sweep_json(const Sweep& sweep) {
    using Json = nlohmann::ordered_json;
    const auto json = [](std::optional<double> v) { return v ? Json(*v) : Json(nullptr); };
    Json rows = Json::array(), exponents = Json::array();
    for (const SweepRow& row : sweep.rows) {
        Json values = Json::array();
        for (const std::optional<double>& value : row.values)
            values.push_back(json(value));
        rows.push_back({{"x", row.x}, {"values", values}});
    }
    for (size_t column = 0; column < sweep.columns.size(); ++column)
        exponents.push_back(json(fitted_exponent(sweep, column)));
    const Json document = {{"scene", sweep.scene},     {"over", sweep.over},
                           {"columns", sweep.columns}, {"rows", rows},
                           {"exponents", exponents},   {"complete", sweep.complete}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace ovc
