// SPDX-License-Identifier: Apache-2.0
// Writes a bench's result for people: a table of what was built and one for each workload.
#include "host/arguments/memory_size.h"
#include "host/bench/bench_text.h"
#include "host/bench/ratios/ratios.h"
#include "host/terminal/text_table.h"

#include <fmt/format.h>

#include <algorithm>

namespace ovc {

namespace {

std::string number(std::optional<double> value, int decimals) {
    return value ? fmt::format("{:.{}f}", *value, decimals) : "-";
}

std::string percent(uint64_t part, uint64_t whole) {
    return fmt::format("{:.3f}", whole ? 100.0 * double(part) / double(whole) : 0.0);
}

std::string heading(const BenchResult& r) {
    return fmt::format("{}: {} triangles, {} x {}, {} threads, {} repeats in turn, imported in "
                       "{:.2f} s, load {:.1f} before and {:.1f} after\n",
                       r.scene, human_count(r.triangles), r.width, r.height, r.threads, r.repeats,
                       r.seconds_import, r.load_before, r.load_after);
}

TextRow build_row(const BenchResult& r, const BenchEntrant& e) {
    const bool pages = e.contender.on_gpu();
    return {e.contender.label(),
            pages ? human_count(e.built.leaves) : "-",
            pages ? human_bytes(e.built.level2_bytes) : "-",
            number(bytes_a_triangle(r, e), 1),
            pages ? human_bytes(e.built.gpu_budget_bytes) : "-",
            fmt::format("{:.3f}", e.built.seconds_level1),
            fmt::format("{:.3f}", e.built.seconds_level2),
            fmt::format("{:.3f}", e.build_seconds()),
            number(build_time_to_embree(r, e), 2)};
}

std::string build_table(const BenchResult& r) {
    std::vector<TextRow> rows = {{"build", "leaves", "level 2", "bytes/triangle", "budget",
                                  "level 1 s", "level 2 s", "build s", "time to Embree"}};
    for (const BenchEntrant& entrant : r.entrants)
        rows.push_back(build_row(r, entrant));
    return markdown_table(rows);
}

TextRow work_header(const std::string& workload, bool sweep) {
    TextRow header = {workload,
                      "call s",
                      "min",
                      "max",
                      "Mrays/s",
                      "CPU s",
                      "pass s",
                      "kernel s",
                      "kernel Mrays/s",
                      "speed to robust",
                      "kernel to robust",
                      "CPU to robust",
                      "time to fast",
                      "kernel to fast",
                      "CPU to fast",
                      "differ",
                      "flagged %",
                      "retraced %",
                      "passes",
                      "moved",
                      "checksum"};
    if (sweep)
        header.insert(header.begin() + 15, {"time to first", "kernel to first"});
    return header;
}

TextRow work_row(const BenchResult& r, const Measurement& m, bool sweep) {
    const Contender& contender = r.entrants[m.entrant].contender;
    const bool on_gpu = contender.on_gpu();
    const Spread call = spread_of(m.seconds);
    const Spread kernel = spread_of(m.kernel_seconds);
    const Ratios ratios = ratios_of(r, m);
    TextRow row = {contender.label(),
                   fmt::format("{:.4f}", call.median),
                   fmt::format("{:.4f}", call.min),
                   fmt::format("{:.4f}", call.max),
                   number(mrays(m, call.median), 2),
                   fmt::format("{:.4f}", spread_of(m.cpu_seconds).median),
                   on_gpu ? fmt::format("{:.4f}", spread_of(m.pass_seconds).median) : "-",
                   kernel.max > 0 ? fmt::format("{:.4f}", kernel.median) : "-",
                   number(mrays(m, kernel.median), 2),
                   number(ratios.call_speed_to_robust, 2),
                   number(ratios.kernel_speed_to_robust, 2),
                   number(ratios.cpu_speed_to_robust, 2),
                   number(ratios.call_time_to_fast, 2),
                   number(ratios.kernel_time_to_fast, 2),
                   number(ratios.cpu_time_to_fast, 2),
                   human_count(m.differing),
                   on_gpu ? percent(m.flagged, m.rays) : "-",
                   on_gpu ? percent(m.retraced, m.rays) : "-",
                   on_gpu ? human_count(m.passes) : "-",
                   on_gpu ? human_bytes(m.bytes_in) : "-",
                   fmt::format("{:016x}", m.checksum)};
    if (sweep)
        row.insert(row.begin() + 15,
                   {number(ratios.call_time_to_first, 2), number(ratios.kernel_time_to_first, 2)});
    return row;
}

bool has_sweep(const BenchResult& r) {
    for (const BenchEntrant& a : r.entrants)
        for (const BenchEntrant& b : r.entrants)
            if (&a != &b && a.contender.name == b.contender.name)
                return true;
    return false;
}

/// Returns an empty string where nothing was timed.
std::string work_table(const BenchResult& r, size_t workload) {
    const bool sweep = has_sweep(r);
    std::vector<TextRow> rows;
    uint64_t rays = 0;
    for (const Measurement& m : r.measurements)
        if (m.workload == workload) {
            rows.push_back(work_row(r, m, sweep));
            rays = std::max(rays, m.rays);
        }
    if (rows.empty())
        return "";
    rows.insert(
        rows.begin(),
        work_header(fmt::format("{}, {} rays", r.workloads[workload], human_count(rays)), sweep));
    return fmt::format("\n{}", markdown_table(rows));
}

} // namespace

std::string bench_table(const BenchResult& r) {
    std::string text = fmt::format("{}\n{}", heading(r), build_table(r));
    for (size_t workload = 0; workload < r.workloads.size(); ++workload)
        text += work_table(r, workload);
    if (!r.complete)
        text += "\nInterrupted: these are the calls that were done.\n";
    return text;
}

} // namespace ovc
