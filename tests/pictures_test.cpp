// SPDX-License-Identifier: Apache-2.0
// Tests that overcast, povray and tachyon draw the same picture of the same triangles, that more
// samples bring it nearer to the exact picture, and finer triangles nearer to exact shapes.
#include "tests/run_command.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <map>

namespace ovc {
namespace {

/// path: the folders to look for other programs in, or empty for the ones of the environment.
nlohmann::json bench(const std::string& words, const std::string& path = {}) {
    const test::CommandResult run = test::run_shell(
        (path.empty() ? "" : "PATH=" + path + " ") + OVC_BINARY_DIR "/bin/overcast bench " + words +
        " --size 64x64 --repeats 1 --json - --log-level error");
    EXPECT_EQ(run.exit_code, 0) << run.output;
    return nlohmann::json::parse(run.output, nullptr, /* allow_exceptions= */ false);
}

TEST(Pictures, OfAllProgramsComeNearerToOneWithMoreSamples) {
    const nlohmann::json found = bench("sphere-2 --pictures samples --most 16");
    ASSERT_TRUE(found.is_object());
    EXPECT_EQ(found["reference_samples"], 64);
    std::map<std::string, std::map<int, double>> errors;
    for (const auto& choice : found["choices"])
        errors[choice["program"]][choice["samples"]] = choice["rmse"];
    const size_t missing = found["not_installed"].size();
    EXPECT_GE(errors.size(), 5 - missing);
    for (const auto& [program, by_samples] : errors) {
        ASSERT_EQ(by_samples.size(), 3u) << program;
        EXPECT_GT(by_samples.at(1), by_samples.at(16)) << program;
        // One ray goes through each pixel's middle, so every program draws the same pixels.
        EXPECT_NEAR(by_samples.at(1), errors["certified"][1], 0.02 * errors["certified"][1])
            << program;
        EXPECT_LT(by_samples.at(16), 0.6 * by_samples.at(1)) << program;
    }
    EXPECT_EQ(errors["certified"], errors["cpu-kdtree"]);
}

TEST(Pictures, AreDrawnWithoutWhatIsNotInstalled) {
    const nlohmann::json samples = bench("box --pictures samples --most 1", "/nowhere");
    ASSERT_TRUE(samples.is_object());
    EXPECT_EQ(samples["not_installed"], nlohmann::json({"povray", "tachyon"}));
    EXPECT_EQ(samples["choices"][0]["program"], "certified");
    for (const auto& choice : samples["choices"])
        EXPECT_TRUE(choice["rmse"].is_number());
    const nlohmann::json tolerance = bench("--pictures tolerance", "/nowhere");
    ASSERT_TRUE(tolerance.is_object());
    EXPECT_TRUE(tolerance["povray"].is_null());
    EXPECT_GE(tolerance["rows"].size(), 5u);
    for (const auto& row : tolerance["rows"])
        EXPECT_TRUE(row["picture"].is_null());
}

TEST(Pictures, OfRoundShapesComeNearerToThemWithinTheTolerance) {
    const nlohmann::json found = bench("--pictures tolerance");
    ASSERT_TRUE(found.is_object());
    ASSERT_GE(found["rows"].size(), 5u);
    double last = 1, largest_rmse = 0;
    for (const auto& row : found["rows"]) {
        if (row["tolerance"].is_null())
            continue; // This row uses the reader's own tolerance.
        for (const auto& [shape, off] : row["largest_distance"].items()) {
            EXPECT_GT(off, 0.0) << shape;
            EXPECT_LE(off, row["tolerance"]) << shape;
        }
        EXPECT_LT(row["rms_distance"], last);
        last = row["rms_distance"];
        if (!row["picture"].is_null())
            largest_rmse = std::max(largest_rmse, row["picture"]["rmse"].get<double>());
    }
    if (!found["povray"].is_null()) {
        EXPECT_GT(largest_rmse, 0.01);
        EXPECT_EQ(found["povray"]["rmse"], 0);
        EXPECT_LT(found["rows"][6]["picture"]["rmse"], 0.1 * largest_rmse);
    }
}

} // namespace
} // namespace ovc
