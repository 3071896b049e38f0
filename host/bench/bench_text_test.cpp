// SPDX-License-Identifier: Apache-2.0
// Tests that tables and JSON agree, and that JSON has the keys that docs/benchmarks.md lists.
#include "host/bench/bench_text.h"
#include "host/bench/ratios/ratios.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <fstream>
#include <iterator>
#include <sstream>

namespace ovc {
namespace {

BenchResult example_result() {
    BenchResult result;
    result.scene = "caf\xe9.ply"; // not UTF-8
    result.triangles = 1000;
    result.width = result.height = 1024;
    result.threads = 2;
    result.repeats = 3;
    result.complete = true;
    result.workloads = {"primary", "frame"};
    const Result<std::vector<Contender>> contenders =
        choose_contenders(std::vector<std::string>{"certified", "fast", "cpu", "embree"},
                          std::vector<LeavesChoice>{{1, "1"}, {8, "8"}},
                          std::vector<BudgetChoice>(1), std::vector<InstancesChoice>(1));
    EXPECT_TRUE(bool(contenders));
    for (const Contender& contender : *contenders) {
        result.entrants.push_back({contender, "a renderer", {}, {}});
        if (contender.kind == ContenderKind::TwoLevel)
            result.entrants.back().built.level2_bytes = 52000;
        result.entrants.back().built.seconds_level2 = 0.125;
    }
    for (size_t w = 0; w < result.workloads.size(); ++w)
        for (size_t e = 0; e < result.entrants.size(); ++e) {
            const double base = 0.1 * double(e + 1) + double(w);
            const bool kernel = result.entrants[e].contender.kind == ContenderKind::TwoLevel;
            Measurement m{.entrant = e, .workload = w, .rays = 1048576, .checksum = 0xabcdef + e};
            m.seconds = {base, base + 0.02, base + 0.01};
            m.cpu_seconds = {2 * base, 2 * base, 3 * base};
            m.pass_seconds = std::vector<double>(3, kernel ? base / 1.5 : 0);
            m.kernel_seconds = std::vector<double>(3, kernel ? base / 2 : 0);
            m.flagged = 1000;
            result.measurements.push_back(m);
        }
    return result;
}

/// Returns the cells of the table whose first column is headed by `head`, with its header first.
std::vector<std::vector<std::string>> rows_of(const std::string& text, const std::string& head) {
    std::vector<std::vector<std::string>> rows;
    std::istringstream lines(text);
    bool inside = false;
    for (std::string line; std::getline(lines, line);) {
        inside = inside ? !line.empty() : line.starts_with("| " + head);
        if (!inside || line.starts_with("|-"))
            continue;
        std::vector<std::string> cells;
        std::istringstream in(line.substr(1));
        for (std::string cell; std::getline(in, cell, '|');) {
            const size_t first = cell.find_first_not_of(' ');
            cells.push_back(cell.substr(first, cell.find_last_not_of(' ') + 1 - first));
        }
        rows.push_back(cells);
    }
    return rows;
}

/// Returns the cell under `title` in a row of rows_of(), or "" where there is no such column.
std::string cell(const std::vector<std::vector<std::string>>& rows, size_t row, const char* title) {
    const auto at = std::find(rows[0].begin(), rows[0].end(), title);
    return at == rows[0].end() ? "" : rows[row][size_t(at - rows[0].begin())];
}

std::string shown(const nlohmann::json& value, int decimals) {
    return value.is_null() ? "-" : fmt::format("{:.{}f}", value.get<double>(), decimals);
}

TEST(BenchText, JsonHasWhatTheTableShows) {
    const BenchResult result = example_result();
    const std::string text = bench_table(result);
    const auto document = nlohmann::json::parse(bench_json(std::vector{result}));
    const auto& scene = document["scenes"][0];
    ASSERT_EQ(scene["measurements"].size(), result.measurements.size());
    size_t compared = 0;
    for (const char* workload : {"primary", "frame"}) {
        const auto rows = rows_of(text, fmt::format("{}, 1,048,576 rays", workload));
        ASSERT_EQ(rows.size(), 1 + result.entrants.size());
        size_t row = 0;
        for (const auto& m : scene["measurements"]) {
            if (m["workload"] != workload)
                continue;
            SCOPED_TRACE(m["contender"].get<std::string>());
            const auto& kernel = m["kernel_seconds"];
            ++row;
            EXPECT_EQ(rows[row][0], m["contender"].get<std::string>());
            EXPECT_EQ(cell(rows, row, "call s"), shown(m["call_seconds"]["median"], 4));
            EXPECT_EQ(cell(rows, row, "min"), shown(m["call_seconds"]["min"], 4));
            EXPECT_EQ(cell(rows, row, "max"), shown(m["call_seconds"]["max"], 4));
            EXPECT_EQ(cell(rows, row, "Mrays/s"), shown(m["call_seconds"]["mrays_per_second"], 2));
            const auto& pass = m["pass_seconds"];
            EXPECT_EQ(cell(rows, row, "pass s"), shown(pass.is_null() ? pass : pass["median"], 4));
            EXPECT_EQ(cell(rows, row, "kernel s"),
                      shown(kernel.is_null() ? kernel : kernel["median"], 4));
            EXPECT_EQ(cell(rows, row, "CPU s"), shown(m["cpu_seconds"]["median"], 4));
            EXPECT_EQ(cell(rows, row, "CPU to robust"), shown(m["cpu_speed_to_robust"], 2));
            EXPECT_EQ(cell(rows, row, "CPU to fast"), shown(m["cpu_time_to_fast"], 2));
            EXPECT_EQ(cell(rows, row, "kernel to first"), shown(m["kernel_time_to_first"], 2));
            EXPECT_EQ(cell(rows, row, "speed to robust"), shown(m["call_speed_to_robust"], 2));
            EXPECT_EQ(cell(rows, row, "kernel to robust"), shown(m["kernel_speed_to_robust"], 2));
            EXPECT_EQ(cell(rows, row, "time to fast"), shown(m["call_time_to_fast"], 2));
            EXPECT_EQ(cell(rows, row, "kernel to fast"), shown(m["kernel_time_to_fast"], 2));
            EXPECT_EQ(cell(rows, row, "time to first"), shown(m["call_time_to_first"], 2));
            EXPECT_EQ(cell(rows, row, "checksum"), m["checksum"].get<std::string>());
            ++compared;
        }
    }
    EXPECT_EQ(compared, result.measurements.size());
}

TEST(BenchText, SaysWhoWasBuilt) {
    const BenchResult result = example_result();
    const auto rows = rows_of(bench_table(result), "build");
    const auto document = nlohmann::json::parse(bench_json(std::vector{result}));
    const auto& contenders = document["scenes"][0]["contenders"];
    ASSERT_EQ(rows.size(), 1 + contenders.size());
    for (size_t i = 0; i < contenders.size(); ++i) {
        EXPECT_EQ(rows[i + 1][0], contenders[i]["label"].get<std::string>());
        EXPECT_EQ(cell(rows, i + 1, "bytes/triangle"), shown(contenders[i]["bytes_a_triangle"], 1));
        EXPECT_EQ(cell(rows, i + 1, "build s"), shown(contenders[i]["build_seconds"]["total"], 3));
    }
    EXPECT_EQ(cell(rows, 1, "bytes/triangle"), "52.0");
}

TEST(BenchText, LeavesOutTheSweepWhereThereIsNone) {
    BenchResult result = example_result();
    for (size_t e = 0; e < result.entrants.size(); ++e)
        result.entrants[e].contender.name = contender_names()[0];
    EXPECT_THAT(bench_table(result), testing::HasSubstr("time to first"));
    result.entrants.resize(1);
    result.measurements.resize(1);
    EXPECT_THAT(bench_table(result), testing::Not(testing::HasSubstr("time to first")));
}

TEST(BenchText, SaysThatItWasInterrupted) {
    BenchResult result = example_result();
    EXPECT_THAT(bench_table(result), testing::Not(testing::HasSubstr("Interrupted")));
    result.complete = false;
    result.measurements.clear();
    EXPECT_THAT(bench_table(result), testing::HasSubstr("Interrupted"));
    EXPECT_EQ(nlohmann::json::parse(bench_json(std::vector{result}))["scenes"][0]["complete"],
              false);
}

TEST(BenchText, EveryKeyIsDocumented) {
    std::ifstream file(OVC_SOURCE_DIR "/docs/benchmarks.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const nlohmann::json flat =
        nlohmann::json::parse(bench_json(std::vector{example_result()})).flatten();
    for (const auto& [path, value] : flat.items()) {
        std::string key = path;
        while (std::isdigit(key.back())) // the index in a list
            key.resize(key.rfind('/'));
        EXPECT_THAT(text, testing::HasSubstr(fmt::format("`{}`", key.substr(key.rfind('/') + 1))))
            << path;
    }
}

} // namespace
} // namespace ovc
