// SPDX-License-Identifier: Apache-2.0
// Statistics: the keys that docs/reference/stats.md promises.
#include "host/output/stats.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace ovc {

static RenderStats example_stats() {
    RenderStats stats;
    stats.scene = "caf\xe9.ply"; // not UTF-8
    stats.renderer = "llvmpipe (LLVM 15, 256 bits)";
    FrameStats frame;
    frame.frame = 7;
    frame.report.rays = {262144, 100000, 5};
    frame.report.complete = true;
    frame.tracing.passes = 3;
    stats.add(frame);
    stats.report.complete = true;
    stats.tracing.triangles = 871414;
    stats.tracing.leaves = 11;
    stats.tracing.level2_bytes = 48 << 20;
    stats.tracing.gpu_budget_bytes = 12 << 20;
    stats.tracing.gpu_peak_bytes = 11 << 20;
    return stats;
}

TEST(StatsJson, HasTheKeysOfItsDocument) {
    const nlohmann::json document = nlohmann::json::parse(stats_json(example_stats()));
    for (const char* key : {"triangles", "leaves", "level2_bytes", "gpu_budget_bytes",
                            "gpu_peak_bytes", "host_peak_bytes", "passes", "pages_in", "bytes_in",
                            "rays", "flagged", "time", "renderer"})
        EXPECT_TRUE(document.contains(key)) << key;
    for (const char* key : {"import", "level1", "level2", "trace", "shade", "output", "total"})
        EXPECT_TRUE(document["time"].contains(key)) << key;
    EXPECT_EQ(document["rays"]["primary"], 262144);
    EXPECT_EQ(document["rays"]["shadow"], 100000);
    EXPECT_EQ(document["rays"]["reflection"], 5);
    EXPECT_EQ(document["gpu_budget_bytes"], 12 << 20);
    EXPECT_GT(document["host_peak_bytes"], 1 << 20);
}

TEST(StatsJson, EveryKeyIsDocumented) {
    std::ifstream file(OVC_SOURCE_DIR "/docs/reference/stats.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const nlohmann::json flat = nlohmann::json::parse(stats_json(example_stats())).flatten();
    for (const auto& [key, value] : flat.items())
        EXPECT_THAT(text, testing::HasSubstr(fmt::format("`{}`", key.substr(key.rfind('/') + 1))))
            << key;
}

TEST(StatsJson, HasAnEntryAFrameAndTheirSum) {
    RenderStats stats = example_stats();
    FrameStats second;
    second.frame = 8;
    second.report.rays = {1000, 200, 30};
    second.report.seconds_trace = 2;
    stats.add(second);
    const nlohmann::json document = nlohmann::json::parse(stats_json(stats));
    ASSERT_EQ(document["frames"].size(), 2u);
    EXPECT_EQ(document["frames"][0]["frame"], 7);
    EXPECT_EQ(document["frames"][0]["passes"], 3);
    EXPECT_EQ(document["frames"][1]["rays"]["shadow"], 200);
    EXPECT_EQ(document["frames"][1]["complete"], false);
    EXPECT_EQ(document["rays"]["primary"], 263144);
    EXPECT_EQ(document["rays"]["reflection"], 35);
    EXPECT_EQ(document["time"]["trace"], 2);
}

TEST(StatsCounters, OfAFrameAreWhatWasCountedInBetween) {
    ovc_statistics before{}, after{};
    before.passes = 10;
    before.bytes_in = 1000;
    before.seconds_kernel = 1.5;
    after.passes = 14;
    after.bytes_in = 1000;
    after.seconds_kernel = 2;
    after.leaves = 9;
    after.gpu_peak_bytes = 77;
    const ovc_statistics counted = counted_between(before, after);
    EXPECT_EQ(counted.passes, 4u);
    EXPECT_EQ(counted.bytes_in, 0u);
    EXPECT_EQ(counted.seconds_kernel, 0.5);
    EXPECT_EQ(counted.leaves, 9u);
    EXPECT_EQ(counted.gpu_peak_bytes, 77u);
}

TEST(StatsCounters, OfStructuresThatAreGoneAreAdded) {
    ovc_statistics earlier{}, now{};
    earlier.passes = 10;
    earlier.leaves = 3;
    now.passes = 4;
    now.leaves = 9;
    const ovc_statistics counted = counted_besides(earlier, now);
    EXPECT_EQ(counted.passes, 14u);
    EXPECT_EQ(counted.leaves, 9u);
}

TEST(StatsSummary, SaysWhatAPersonWantsToKnow) {
    const std::string text = stats_summary(example_stats());
    for (const char* part :
         {"871,414 triangles", "leaves     11", "11.0 MiB at most, of a budget of 12.0 MiB",
          "llvmpipe", "362,149: 262,144 primary, 100,000 shadow, 5 reflection, 0 refraction"})
        EXPECT_THAT(text, testing::HasSubstr(part));
    RenderStats on_cpu;
    EXPECT_THAT(stats_summary(on_cpu), testing::Not(testing::HasSubstr("budget")));
}

} // namespace ovc
