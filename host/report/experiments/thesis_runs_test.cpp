// SPDX-License-Identifier: Apache-2.0
// Tests frames of the thesis' systems, from statistics such as `overcast render` writes.
#include "host/report/experiments/thesis_runs.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

/// Returns statistics of two frames, of which the second takes twice as much of everything.
Json stats_of(double seconds, double cpu, int passes) {
    Json stats = {{"level2_bytes", 1000},
                  {"bytes_in", 4e6},
                  {"time", {{"level1", 1}, {"level2", 2}, {"pass", 3}, {"shade", 5}}}};
    for (const int times : {1, 2})
        stats["frames"].push_back({{"frame", times},
                                   {"time", {{"render", times * seconds}, {"cpu", times * cpu}}},
                                   {"passes", times * passes},
                                   {"rays", {{"primary", 100}, {"shadow", 50}}},
                                   {"active", {{"bytes", 500}, {"new_bytes", 250}}}});
    return stats;
}

TEST(FramesOf, HasMeansAndAValueForEachFrame) {
    const Json frames = frames_of("mixed", stats_of(2, 3, 10));
    EXPECT_EQ(frames["name"], "two-level, mixed");
    EXPECT_EQ(frames["mean_seconds"], 3.0);
    EXPECT_EQ(frames["mean_cpu"], 4.5);
    EXPECT_EQ(frames["mean_calls"], 15.0);
    EXPECT_EQ(frames["mean_rays"], 150.0);
    EXPECT_EQ(frames["pass_seconds"], 1.5);
    EXPECT_EQ(frames["shade_seconds"], 2.5);
    EXPECT_EQ(frames["moved_mb"], 2.0);
    EXPECT_EQ(frames["build_seconds"], 3.0);
    EXPECT_EQ(frames["seconds"], Json({2.0, 4.0}));
    EXPECT_EQ(frames["active"], Json({0.5, 0.5}));
    EXPECT_EQ(frames["incremental"], Json({0.25, 0.25}));
    EXPECT_TRUE(frames_of("kdt", stats_of(2, 3, 10))["mean_calls"].is_null()) << "it has no GPU";
}

/// Other programs on the machine change wall time, and a GPU's time is not in CPU seconds.
TEST(CostBy, IsCpuSecondsOnASoftwareRendererAlone) {
    const Json systems = {frames_of("batched", stats_of(2, 3, 10)),
                          frames_of("mixed", stats_of(8, 6, 5))};
    const auto ratio = [&](const char* renderer) {
        return ratio_of(systems, cost_by(renderer).mean, "mixed", "batched");
    };
    EXPECT_EQ(ratio("llvmpipe (LLVM 15.0.6, 256 bits)"), 2.0);
    EXPECT_EQ(ratio("NVIDIA H200/PCIe/SSE2"), 4.0);
    EXPECT_TRUE(ratio_of(systems, "mean_cpu", "mixed", "kdt").is_null());
}

std::vector<std::string> pointers_of(const Text& text) {
    std::vector<std::string> pointers;
    for (const Piece& piece : text)
        if (const auto* number = std::get_if<Number>(&piece))
            pointers.push_back(number->pointer);
    return pointers;
}

TEST(WhyTexts, PointAtTheSystemsTheyCompare) {
    const Json figures = {
        {"few",
         {frames_of("kdt", stats_of(1, 1, 0)), frames_of("batched", stats_of(2, 3, 10)),
          frames_of("mixed", stats_of(8, 6, 5))}}};
    EXPECT_THAT(pointers_of(mixed_text(figures, "/few")),
                testing::ElementsAre("/few/2/mean_calls", "/few/1/mean_calls",
                                     "/few/2/pass_seconds", "/few/1/pass_seconds",
                                     "/few/2/shade_seconds", "/few/1/shade_seconds",
                                     "/few/2/mean_cpu", "/few/1/mean_cpu"));
    EXPECT_THAT(pointers_of(kdtree_text(figures, "/few")),
                testing::ElementsAre("/few/0/mean_cpu", "/few/1/mean_cpu", "/few/0/build_seconds",
                                     "/few/1/build_seconds"));
    const Json alone = {{"few", {frames_of("mixed", stats_of(8, 6, 5))}}};
    EXPECT_TRUE(mixed_text(alone, "/few").empty());
    EXPECT_TRUE(kdtree_text(alone, "/few").empty());
}

} // namespace
} // namespace ovc
