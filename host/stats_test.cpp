// SPDX-License-Identifier: Apache-2.0
// Statistics: the keys that docs/stats.md promises.
#include "host/stats.h"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>

namespace ovc {

static RenderStats example() {
    RenderStats stats;
    stats.scene = "caf\xe9.ply"; // not UTF-8
    stats.renderer = "llvmpipe (LLVM 15, 256 bits)";
    stats.report.rays = {262144, 100000, 5};
    stats.report.complete = true;
    stats.tracing.triangles = 871414;
    stats.tracing.leaves = 11;
    stats.tracing.level2_bytes = 48 << 20;
    stats.tracing.gpu_budget_bytes = 12 << 20;
    stats.tracing.gpu_peak_bytes = 11 << 20;
    return stats;
}

TEST(StatsJson, HasTheKeysOfItsDocument) {
    const nlohmann::json document = nlohmann::json::parse(stats_json(example()));
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
    std::ifstream file(OVC_SOURCE_DIR "/docs/stats.md");
    const std::string text{std::istreambuf_iterator<char>(file), {}};
    const nlohmann::json flat = nlohmann::json::parse(stats_json(example())).flatten();
    for (const auto& [key, value] : flat.items())
        EXPECT_THAT(text, testing::HasSubstr(fmt::format("`{}`", key.substr(key.rfind('/') + 1))))
            << key;
}

TEST(StatsSummary, SaysWhatAPersonWantsToKnow) {
    const std::string text = stats_summary(example());
    for (const char* part :
         {"871,414 triangles", "leaves     11", "11.0 MiB at most, of a budget of 12.0 MiB",
          "llvmpipe", "362,149: 262,144 primary, 100,000 shadow, 5 reflection, 0 refraction"})
        EXPECT_THAT(text, testing::HasSubstr(part));
    RenderStats on_cpu;
    EXPECT_THAT(stats_summary(on_cpu), testing::Not(testing::HasSubstr("budget")));
}

} // namespace ovc
