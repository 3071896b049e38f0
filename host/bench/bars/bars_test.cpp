// SPDX-License-Identifier: Apache-2.0
// Tests which lines pass, fail and are skipped, and which time is divided by which.
#include "host/bench/bars/bars.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace ovc {
namespace {

Contender contender(std::string_view name, ContenderKind kind) {
    return {.name = name, .kind = kind};
}

constexpr PromiseOfSets kPromises = {{{1, 1.2}, {1, 1.2}, {1, 1.2}}};

/// Returns times of every contender at every workload, the same at each workload.
BenchResult example_of_bars() {
    BenchResult r;
    r.complete = true;
    r.triangles = 1000;
    r.workloads = {"primary", "shadow", "diffuse", "frame"};
    r.entrants = {{contender("certified", ContenderKind::TwoLevel), "", {}, {}},
                  {contender("fast", ContenderKind::TwoLevel), "", {}, {}},
                  {contender("cpu-float-kdtree", ContenderKind::FloatKdTree), "", {}, {}},
                  {contender("embree-robust", ContenderKind::Embree), "", {}, {}}};
    r.entrants[0].built.level2_bytes = 50000;
    const double call[] = {1, 0.5, 2, 0.9};
    const double kernel[] = {0.5, 0.4, 0, 0.6};
    for (size_t w = 0; w < r.workloads.size(); ++w)
        for (size_t e = 0; e < r.entrants.size(); ++e) {
            Measurement m{.entrant = e, .workload = w, .rays = 100};
            m.seconds = m.cpu_seconds = m.pass_seconds = {call[e]};
            m.kernel_seconds = {kernel[e]};
            r.measurements.push_back(m);
        }
    return r;
}

TEST(Bars, DivideThePeersKernelByOurs) {
    const BenchResult r = example_of_bars();
    const std::vector<Bar> bars = kernel_bars(r, "mesh", "embree-robust", kPromises);
    ASSERT_EQ(bars.size(), 3u);
    EXPECT_EQ(bars[0].what, "kernel against embree-robust, mesh: primary");
    EXPECT_DOUBLE_EQ(*bars[0].measured, 1.2);
    EXPECT_EQ(verdict(bars[0]), "passed");
    // Its call of 2 s, since it reports no kernel seconds.
    EXPECT_DOUBLE_EQ(*kernel_bars(r, "mesh", "cpu-float-kdtree", kPromises)[0].measured, 4);
}

TEST(Bars, DivideThePeersCallByOurs) {
    const std::vector<Bar> bars = call_bars(example_of_bars(), "city", "embree-robust", kPromises);
    ASSERT_EQ(bars.size(), 3u);
    EXPECT_EQ(bars[1].what, "call against embree-robust, city: shadow");
    EXPECT_DOUBLE_EQ(*bars[1].measured, 0.9);
    EXPECT_EQ(verdict(bars[1]), "failed"); // at least 1
}

TEST(Bars, DivideTheFrameByThatOfFastPrecision) {
    const Bar bar = certify_bar(example_of_bars());
    EXPECT_DOUBLE_EQ(*bar.measured, 2);
    EXPECT_EQ(verdict(bar), "failed");
}

TEST(Bars, DivideARayAtASideByAPrimaryRay) {
    BenchResult r = example_of_bars();
    EXPECT_EQ(verdict(edges_bar(r)), "skipped");
    r.workloads.push_back("edges");
    Measurement edges = r.measurements[0];
    edges.workload = r.workloads.size() - 1;
    edges.rays = 50; // half as many as primary rays, in twice the time
    edges.seconds = {2};
    r.measurements.push_back(edges);
    EXPECT_DOUBLE_EQ(*edges_bar(r).measured, 4);
    EXPECT_EQ(verdict(edges_bar(r)), "passed");
}

TEST(Bars, DivideSmallCallsByOneCall) {
    BenchResult r = example_of_bars();
    EXPECT_EQ(verdict(small_calls_bars(r)[0]), "skipped");
    r.workloads.push_back("primary-small");
    Measurement small = r.measurements[0];
    small.workload = r.workloads.size() - 1;
    for (double& seconds : small.seconds)
        seconds *= 1.25;
    r.measurements.push_back(small);
    EXPECT_DOUBLE_EQ(*small_calls_bars(r)[0].measured, 1.25);
    EXPECT_EQ(verdict(small_calls_bars(r)[0]), "passed");
    EXPECT_EQ(verdict(small_calls_bars(r)[1]), "skipped");
}

TEST(Bars, AreNotJudgedWhereTheirTurnsLieOnBothSides) {
    BenchResult r = example_of_bars();
    for (Measurement& m : r.measurements)
        if (m.workload == 0)
            m.kernel_seconds =
                m.entrant == 0 ? std::vector<double>{1, 1, 1} : std::vector<double>{1.3, 0.9, 1.2};
    const Bar noisy = kernel_bars(r, "mesh", "embree-robust", kPromises)[0];
    EXPECT_DOUBLE_EQ(*noisy.measured, 1.2);
    EXPECT_EQ(verdict(noisy), "too noisy");
    for (Measurement& m : r.measurements)
        if (m.workload == 0 && m.entrant != 0)
            m.kernel_seconds = {1.3, 1.1, 1.2};
    EXPECT_EQ(verdict(kernel_bars(r, "mesh", "embree-robust", kPromises)[0]), "passed");
    EXPECT_EQ(failed_bars(std::vector{noisy}), "");
    EXPECT_THAT(bars_table(std::vector{noisy}), testing::HasSubstr("1 are too noisy to judge"));
}

TEST(Bars, NameTheLinesThatFail) {
    std::vector<Bar> bars = {certify_bar(example_of_bars()), skipped_bar("leaks", "a test")};
    EXPECT_EQ(failed_bars(bars), "1 of 2 lines do not hold: frame, certified against fast");
    bars[0].at_least = 2;
    EXPECT_EQ(failed_bars(bars), "");
}

TEST(Bars, AreSkippedWithoutThePeer) {
    BenchResult r = example_of_bars();
    std::erase_if(r.measurements, [](const Measurement& m) { return m.entrant == 3; });
    const std::vector<Bar> bars = kernel_bars(r, "mesh", "embree-robust", kPromises);
    EXPECT_EQ(verdict(bars[0]), "skipped");
    EXPECT_THAT(bars[0].note, testing::HasSubstr("embree-robust did not take part"));
}

TEST(Bars, SumTheRaySetsOfEachPlaceInASweep) {
    BenchResult r = example_of_bars();
    for (BenchEntrant& entrant : r.entrants)
        entrant.contender.leaves = {8, std::string("8")};
    const std::vector<Bar> bars = leaves_bars(r);
    ASSERT_EQ(bars.size(), 3u);
    EXPECT_DOUBLE_EQ(*bars[1].measured, 2); // 8 s of the third against 4 s of the first
    r.complete = false;
    EXPECT_EQ(verdict(leaves_bars(r)[0]), "skipped");
}

TEST(Bars, TellTheWorstKernelOfManyLeaves) {
    BenchResult r = example_of_bars();
    for (BenchEntrant& entrant : r.entrants)
        entrant.contender = contender("certified", ContenderKind::TwoLevel);
    r.entrants[1].contender.leaves = {14, std::string("14")};
    for (Measurement& m : r.measurements)
        if (m.entrant == 1 && r.workloads[m.workload] == "shadow")
            m.kernel_seconds = {0.6}; // 0.4 at other workloads; 0.5 with one leaf
    const std::vector<Bar> bars = leaves_of_scene_bars(r, "city");
    ASSERT_EQ(bars.size(), 2u);
    EXPECT_EQ(bars[0].what, "kernel in 14 leaves against one, city");
    EXPECT_DOUBLE_EQ(bars[0].measured.value(), 1.2);
    EXPECT_THAT(bars[0].note, testing::HasSubstr("shadow rays"));
    EXPECT_EQ(verdict(bars[0]), "failed");
    r.complete = false;
    EXPECT_EQ(verdict(leaves_of_scene_bars(r, "city")[0]), "skipped");
}

TEST(Bars, CountBytes) {
    BenchResult r = example_of_bars();
    EXPECT_DOUBLE_EQ(*bytes_bar(r, "mesh", 52, 44).measured, 50);
    r.entrants[1].after.gpu_peak_bytes = 100;
    r.entrants[1].after.gpu_budget_bytes = 100;
    EXPECT_EQ(*peak_bar(std::vector{r}).measured, 0);
    EXPECT_EQ(verdict(peak_bar(std::vector{r})), "passed");
    r.entrants[1].after.gpu_budget_bytes = 93;
    EXPECT_EQ(*peak_bar(std::vector{r}).measured, 7);
    EXPECT_EQ(verdict(peak_bar(std::vector{r})), "failed");
}

TEST(Bars, TakeTheWorstPeakOfImportsAndTheSpeedOfTheLast) {
    const std::vector<std::pair<std::string, ImportCost>> files = {
        {"OBJ", {100, 1000, 1400, 1}}, {"binary PLY", {400'000'000, 1000, 1100, 2}}};
    const std::vector<Bar> bars = import_bars(files);
    EXPECT_DOUBLE_EQ(*bars[0].measured, 1.4);
    EXPECT_THAT(bars[0].note, testing::HasSubstr("OBJ"));
    EXPECT_DOUBLE_EQ(*bars[1].measured, 200);
}

TEST(Bars, AreATableAndJsonOfTheSameLines) {
    std::vector<Bar> bars = kernel_bars(example_of_bars(), "mesh", "embree-robust", kPromises);
    bars.push_back(certify_bar(example_of_bars()));
    bars.push_back(skipped_bar("leaks", "a test: ctest -R Leaks"));
    const std::string table = bars_table(bars);
    const std::vector<BenchResult> results = {example_of_bars()};
    const auto document = nlohmann::json::parse(bars_json(bars, results, nullptr));
    ASSERT_EQ(document["bars"].size(), bars.size());
    for (const auto& bar : document["bars"])
        EXPECT_THAT(table, testing::HasSubstr(bar["line"].get<std::string>()));
    EXPECT_THAT(table,
                testing::ContainsRegex(
                    "certified against fast +\\| +2.00 \\| +2.00 \\| +2.00 \\| +at most 1.25 "
                    "\\| +1.10 \\| +failed"));
    EXPECT_THAT(table, testing::HasSubstr("3 lines hold, 1 do not, 1 were not measured here."));
    EXPECT_EQ(document["bars"].back()["measured"], nullptr);
    EXPECT_EQ(document["scenes"].size(), 1u);
    EXPECT_EQ(document["programs"], nullptr);
}

} // namespace
} // namespace ovc
