// SPDX-License-Identifier: Apache-2.0
// Writes a bench's result as JSON: everything that the tables show, and each single time.
#include "host/bench/bench_text.h"
#include "host/bench/ratios/ratios.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ovc {

namespace {

// Keys stay in the order they are written here, as docs/benchmarks.md lists them.
using Json = nlohmann::ordered_json;

Json json_of(std::optional<double> value) {
    return value ? Json(*value) : Json(nullptr);
}

Json json_of_times(const Measurement& m, const std::vector<double>& seconds) {
    const Spread spread = spread_of(seconds);
    return {{"min", spread.min},
            {"median", spread.median},
            {"max", spread.max},
            {"mrays_per_second", json_of(mrays(m, spread.median))},
            {"samples", seconds}};
}

Json json_of(const BenchResult& r, const BenchEntrant& e) {
    const bool pages = e.contender.on_gpu();
    Json object = {{"name", e.contender.name},
                   {"label", e.contender.label()},
                   {"renderer", e.renderer},
                   {"leaves", nullptr},
                   {"level2_bytes", nullptr},
                   {"bytes_a_triangle", json_of(bytes_a_triangle(r, e))},
                   {"gpu_budget_bytes", nullptr},
                   {"gpu_peak_bytes", nullptr},
                   {"build_seconds",
                    {{"level1", e.built.seconds_level1},
                     {"level2", e.built.seconds_level2},
                     {"total", e.build_seconds()}}},
                   {"build_time_to_embree", json_of(build_time_to_embree(r, e))}};
    if (pages) {
        object["leaves"] = e.built.leaves;
        object["level2_bytes"] = e.built.level2_bytes;
        object["gpu_budget_bytes"] = e.built.gpu_budget_bytes;
        object["gpu_peak_bytes"] = e.after.gpu_peak_bytes;
    }
    return object;
}

Json json_of(const BenchResult& r, const Measurement& m) {
    const Contender& contender = r.entrants[m.entrant].contender;
    const bool on_gpu = contender.on_gpu();
    const bool has_kernel = spread_of(m.kernel_seconds).max > 0;
    const Ratios ratios = ratios_of(r, m);
    return {{"workload", r.workloads[m.workload]},
            {"contender", contender.label()},
            {"rays", m.rays},
            {"call_seconds", json_of_times(m, m.seconds)},
            {"cpu_seconds", json_of_times(m, m.cpu_seconds)},
            {"pass_seconds", on_gpu ? json_of_times(m, m.pass_seconds) : Json(nullptr)},
            {"kernel_seconds", has_kernel ? json_of_times(m, m.kernel_seconds) : Json(nullptr)},
            {"call_speed_to_robust", json_of(ratios.call_speed_to_robust)},
            {"kernel_speed_to_robust", json_of(ratios.kernel_speed_to_robust)},
            {"cpu_speed_to_robust", json_of(ratios.cpu_speed_to_robust)},
            {"call_time_to_fast", json_of(ratios.call_time_to_fast)},
            {"kernel_time_to_fast", json_of(ratios.kernel_time_to_fast)},
            {"cpu_time_to_fast", json_of(ratios.cpu_time_to_fast)},
            {"call_time_to_first", json_of(ratios.call_time_to_first)},
            {"kernel_time_to_first", json_of(ratios.kernel_time_to_first)},
            {"differ", m.differing},
            {"tied", m.error ? Json(m.verdicts.tied) : Json(nullptr)},
            {"wrong", m.error ? Json(m.verdicts.wrong) : Json(nullptr)},
            {"beside", m.error ? Json(m.verdicts.beside) : Json(nullptr)},
            {"leaked", m.error ? Json(m.verdicts.leaked) : Json(nullptr)},
            {"t_error_largest", m.error ? Json(m.error->largest) : Json(nullptr)},
            {"t_error_rms", m.error ? Json(m.error->rms) : Json(nullptr)},
            {"t_error_ulps", m.error ? Json(m.error->largest_ulps) : Json(nullptr)},
            {"flagged", m.flagged},
            {"retraced", m.retraced},
            {"passes", m.passes},
            {"bytes_in", m.bytes_in},
            {"checksum", fmt::format("{:016x}", m.checksum)}};
}

Json json_of(const BenchResult& r) {
    Json contenders = Json::array(), measurements = Json::array();
    for (const BenchEntrant& entrant : r.entrants)
        contenders.push_back(json_of(r, entrant));
    for (const Measurement& m : r.measurements)
        measurements.push_back(json_of(r, m));
    return {{"scene", r.scene},
            {"triangles", r.triangles},
            {"width", r.width},
            {"height", r.height},
            {"threads", r.threads},
            {"repeats", r.repeats},
            {"complete", r.complete},
            {"import_seconds", r.seconds_import},
            {"load_before", r.load_before},
            {"load_after", r.load_after},
            {"contenders", contenders},
            {"measurements", measurements}};
}

} // namespace

std::string bench_json(std::span<const BenchResult> results) {
    Json scenes = Json::array();
    for (const BenchResult& result : results)
        scenes.push_back(json_of(result));
    const Json document = {{"scenes", scenes}};
    return document.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

} // namespace ovc
