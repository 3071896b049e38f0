// SPDX-License-Identifier: Apache-2.0
// Runs the command with the plugin: certified contenders answer alike, whatever the sweep.
#include "host/backend/plugin_loader.h"
#include "host/command/command.h"
#include "host/terminal/interrupt.h"

#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>

#include <unistd.h>

namespace ovc {
namespace {

bool there_is_a_device() {
    const Result<const ovc_api*> api = load_plugin();
    return api && PluginDevice::open(*api, "", {});
}

nlohmann::json bench(Arguments arguments) {
    arguments.insert(arguments.begin(), "bench");
    arguments.insert(arguments.end(), {"--json", "-"});
    testing::internal::CaptureStdout();
    const Result<int> code = run_command(arguments);
    const std::string text = testing::internal::GetCapturedStdout();
    EXPECT_TRUE(bool(code)) << (code ? "" : code.error().message);
    EXPECT_EQ(code ? *code : kExitError, kExitOk);
    return nlohmann::json::parse(text, nullptr, /* allow_exceptions= */ false);
}

TEST(BenchCommand, CertifiedContendersAnswerAlike) {
    if (!there_is_a_device())
        GTEST_SKIP() << "no device for the plugin";
    const nlohmann::json document =
        bench({"sphere-4", "mirrors", "--only", "certified,cpu-kdtree", "--size", "64x48",
               "--repeats", "1", "--leaves", "1,5", "--gpu-memory", "all,4M"});
    ASSERT_EQ(document["scenes"].size(), 2u);
    for (const auto& scene : document["scenes"]) {
        EXPECT_EQ(scene["complete"], true);
        ASSERT_EQ(scene["contenders"].size(), 2u * 2 * 2 + 1);
        ASSERT_EQ(scene["measurements"].size(), 4u * 9);
        std::map<std::string, std::string> checksums; // by workload
        for (const auto& m : scene["measurements"]) {
            SCOPED_TRACE(m["contender"].get<std::string>() + ", " +
                         m["workload"].get<std::string>());
            const auto [first, is_new] = checksums.try_emplace(m["workload"], m["checksum"]);
            EXPECT_EQ(first->second, m["checksum"].get<std::string>());
            EXPECT_EQ(m["differ"], 0);
            EXPECT_GT(m["rays"], 0);
            EXPECT_GT(m["call_seconds"]["median"], 0.0);
        }
        EXPECT_EQ(checksums.size(), 4u);
        EXPECT_NE(checksums["primary"], checksums["diffuse"]);
    }
}

TEST(BenchCommand, AnswersAreTheSameUnderABudgetOfHostMemory) {
    if (!there_is_a_device())
        GTEST_SKIP() << "no device for the plugin";
    const std::string path = testing::TempDir() + "overcast-bench-" + std::to_string(getpid());
    const std::string file = path + ".ovc";
    ASSERT_TRUE(run_command({"convert", "sphere-5", file, "--leaf-triangles", "500", "--quiet"}));
    const auto checksums = [&](Arguments more) {
        Arguments words{file, "--only", "certified", "--size", "64x48", "--repeats", "1"};
        words.insert(words.end(), more.begin(), more.end());
        std::map<std::string, std::string> found;
        const nlohmann::json document = bench(words);
        for (const auto& m : document["scenes"][0]["measurements"]) {
            EXPECT_EQ(m["differ"], 0);
            found[m["contender"].get<std::string>() + m["workload"].get<std::string>()] =
                m["checksum"];
        }
        return found;
    };
    const auto in_memory = checksums({});
    EXPECT_EQ(in_memory.size(), 2u * 4);
    EXPECT_EQ(checksums({"--host-memory", "1M"}), in_memory);
    EXPECT_THAT(run_command({"bench", file, "--host-memory", "100K"}).error().message,
                testing::HasSubstr("the smallest number that works is "));
    std::filesystem::remove(file);
}

TEST(BenchCommand, InstancesAnswerAlikeSharedOrBaked) {
    if (!there_is_a_device())
        GTEST_SKIP() << "no device for the plugin";
    const nlohmann::json document =
        bench({"fractal-8", "--only", "certified-compute", "--size", "64x48", "--repeats", "1",
               "--instances", "baked,shared"});
    const auto& scene = document["scenes"][0];
    ASSERT_EQ(scene["contenders"].size(), 2u);
    EXPECT_EQ(scene["contenders"][0]["label"], "certified-compute, baked");
    EXPECT_GT(scene["contenders"][0]["level2_bytes"].get<uint64_t>(),
              3 * scene["contenders"][1]["level2_bytes"].get<uint64_t>());
    std::map<std::string, std::string> checksums; // by workload
    for (const auto& m : scene["measurements"])
        EXPECT_EQ(checksums.try_emplace(m["workload"], m["checksum"]).first->second,
                  m["checksum"].get<std::string>())
            << m["workload"];
    EXPECT_EQ(checksums.size(), 4u);
}

TEST(BenchCommand, GivesABudgetAsAShareOfThePages) {
    if (!there_is_a_device())
        GTEST_SKIP() << "no device for the plugin";
    const nlohmann::json document =
        bench({"sphere-6", "--only", "certified-fragment", "--size", "16x16", "--repeats", "1",
               "--leaves", "40", "--resident", "all,30%"});
    const auto& contenders = document["scenes"][0]["contenders"];
    ASSERT_EQ(contenders.size(), 2u);
    const uint64_t all = contenders[0]["level2_bytes"];
    EXPECT_GE(contenders[0]["gpu_budget_bytes"], all);
    EXPECT_NEAR(contenders[1]["gpu_budget_bytes"].get<double>(), 0.3 * double(all), 1);
}

} // namespace
} // namespace ovc
