// SPDX-License-Identifier: Apache-2.0
// Tuning finds the fastest variant in spite of noise, keeps to its time, and does so once.
#include "gpu/tuning/device_tuning.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <fstream>
#include <random>
#include <thread>
#include <vector>

namespace ovc {
namespace {

namespace fs = std::filesystem;

constexpr RayKind kKind{.coherent = true};
constexpr size_t kManyRays = 100000;
constexpr PassCost kLongPass{kManyRays, 1, 1};

/// A device on which each variant takes a time of its own, with noise like that of a busy machine.
class FakeTrials final : public VariantTrials {
public:
    explicit FakeTrials(unsigned seed = 1) : random_(seed) {}

    bool can_run(const KernelVariant& variant) override {
        return variant.reads != TexelReads::Textures;
    }
    void begin(const KernelVariant&) override { ++begun; }
    bool is_ready(const KernelVariant&) override { return begun > 0 && ++asked > slow_compiler; }
    std::optional<double> time(const KernelVariant& variant) override {
        ++trials;
        if (!variant.compute)
            return {};
        std::this_thread::sleep_for(sleep);
        double seconds = 1e-3;
        seconds *= variant.group_size == 128 ? faster : 1;
        seconds *= variant.branches ? faster : 1;
        // Now and then something else takes the cores for a while.
        const double noise = random_() % 10 == 0 ? 1.5 : 1 + 0.01 * double(random_() % 5);
        return seconds * (noisy ? noise : 1);
    }

    std::chrono::milliseconds sleep{0};
    double faster = 0.8;
    bool noisy = false;
    int slow_compiler = 0; // so often it says that it is not ready
    int trials = 0, begun = 0, asked = 0;

private:
    std::mt19937 random_;
};

class Tuning : public testing::Test {
protected:
    void SetUp() override {
        folder = fs::temp_directory_path() / ("ovc_tuning_" + std::to_string(getpid()));
        fs::remove_all(folder);
        device.is_software = device.has_ballots = true;
    }
    void TearDown() override { fs::remove_all(folder); }
    DeviceTuning tuning() const { return {device, TuningFile(folder, "driver"), {}}; }

    fs::path folder;
    DeviceInfo device;
};

TEST_F(Tuning, FindsAllSwitchesThatGain) {
    DeviceTuning found = tuning();
    FakeTrials trials;
    found.after_pass(kKind, kLongPass, TuningLimits::thorough(), trials);
    KernelVariant expected = default_variants(device)[kKind];
    expected.group_size = 128;
    expected.branches = true;
    EXPECT_EQ(found.variants()[kKind].text(), expected.text());
    EXPECT_EQ(found.variants()[RayKind{.any_hit = true}].text(),
              default_variants(device)[RayKind{.any_hit = true}].text());
    EXPECT_EQ(tuning().variants()[kKind].text(), expected.text()) << "it was not kept";
}

// A variant that is as fast as the default apart from noise may be taken, a slower one never.
TEST_F(Tuning, NeverTakesOneThatIsSlowerOverATenthOfTheRunsDisturbed) {
    for (unsigned start = 0; start < 200; ++start) {
        fs::remove_all(folder);
        DeviceTuning found = tuning();
        FakeTrials trials(start);
        trials.noisy = true;
        trials.faster = 1.04;
        found.after_pass(kKind, kLongPass, {.seconds = 10, .kind_seconds = 10}, trials);
        const KernelVariant& chosen = found.variants()[kKind];
        EXPECT_TRUE(!chosen.branches && chosen.group_size != 128)
            << "start " << start << ": " << chosen.text();
    }
}

TEST_F(Tuning, CostsNothingWhereThereAreFewRays) {
    DeviceTuning found = tuning();
    FakeTrials trials;
    for (int i = 0; i < 1000; ++i)
        found.after_pass(kKind, {1000, 1e-3, 1e-3}, {}, trials);
    found.after_pass(kKind, {kManyRays, 1e-3, 1e-3}, {}, trials);
    EXPECT_GT(trials.trials, 0) << "they add up";
    FakeTrials few;
    found.after_pass(RayKind{.any_hit = true}, {kManyRays, 0.05, 0.05}, {}, few);
    EXPECT_EQ(few.begun, 0);
}

TEST_F(Tuning, KeepsToItsTimeInAllRunsTogether) {
    double spent = 0;
    int trials_of_later_runs = 0;
    for (int run = 0; run < 6; ++run) {
        DeviceTuning found = tuning();
        FakeTrials trials;
        trials.sleep = std::chrono::milliseconds(2);
        for (size_t kind = 0; kind < RayKind::kCount; ++kind)
            found.after_pass(RayKind::of(kind), kLongPass, {.seconds = 0.15, .kind_seconds = 0.05},
                             trials);
        spent += 2e-3 * trials.trials; // a machine that is busy sleeps longer
        trials_of_later_runs += run > 0 ? trials.trials : 0;
    }
    EXPECT_LT(spent, 0.2);
    EXPECT_LT(trials_of_later_runs, 40) << "what has no time left is not begun again";
}

TEST_F(Tuning, LeavesADeviceAloneWhoseCompilerTakesAllTheTime) {
    DeviceTuning found = tuning();
    FakeTrials trials;
    found.after_pass(kKind, {kManyRays, 1, 1.3}, {}, trials);
    found.after_pass(kKind, kLongPass, {}, trials);
    EXPECT_EQ(trials.begun, 0);
    EXPECT_EQ(found.variants()[kKind].text(), default_variants(device)[kKind].text());
}

TEST_F(Tuning, WaitsForTheDriversCompilerBesideOtherPasses) {
    DeviceTuning found = tuning();
    FakeTrials trials;
    trials.slow_compiler = 3;
    for (int pass = 0; pass < 3; ++pass)
        found.after_pass(kKind, kLongPass, {}, trials);
    EXPECT_EQ(trials.begun, 1);
    EXPECT_EQ(trials.trials, 0);
    found.after_pass(kKind, kLongPass, {}, trials);
    EXPECT_GT(trials.trials, 0);
}

TEST_F(Tuning, ADamagedFileIsNone) {
    FakeTrials trials;
    tuning().after_pass(kKind, kLongPass, TuningLimits::thorough(), trials);
    const fs::path file = fs::directory_iterator(folder)->path();
    std::ifstream whole(file);
    const std::string text(std::istreambuf_iterator<char>(whole), {});
    ASSERT_TRUE(TuningRecord::from_text(text));
    for (const char* other : {"", "overcast kernel variants 0", "overcast kernel variants 1\nkind",
                              "overcast kernel variants 1\nmicroseconds x"})
        EXPECT_FALSE(TuningRecord::from_text(other)) << other;
    for (size_t at = 0; at < text.size(); ++at) {
        EXPECT_FALSE(TuningRecord::from_text(text.substr(0, at))) << at;
        std::string changed = text;
        changed[at] ^= 1;
        EXPECT_FALSE(TuningRecord::from_text(changed)) << changed;
    }
    EXPECT_FALSE(TuningRecord::from_text(text + text));
    std::ofstream(file) << text << "kind 99 compute";
    EXPECT_EQ(tuning().variants()[kKind].text(), default_variants(device)[kKind].text());
    EXPECT_FALSE(TuningFile(folder, "another driver").load());
    EXPECT_FALSE(TuningFile({}, "driver").load());
}

/// A process has a thread for each device, and devices of one driver share a record.
TEST_F(Tuning, ThreadsThatKeepARecordAtOnceLeaveAWholeOne) {
    const TuningFile file(folder, "driver");
    TuningRecord chosen; // a long text
    chosen.chosen.fill(default_variants(device)[kKind]);
    const auto keep_often = [&](const TuningRecord& record) {
        for (int i = 0; i < 300; ++i)
            file.keep(record);
    };
    file.keep(chosen);
    std::atomic<bool> ends{false};
    std::vector<std::jthread> threads;
    for (int i = 0; i < 2; ++i) {
        threads.emplace_back(keep_often, chosen);
        threads.emplace_back(keep_often, TuningRecord{});
    }
    std::jthread reader([&] {
        while (!ends) {
            const std::optional<TuningRecord> found = file.load();
            ASSERT_TRUE(found);
            EXPECT_TRUE(found->chosen == chosen.chosen || found->chosen == TuningRecord{}.chosen);
        }
    });
    threads.clear();
    ends = true;
    reader.join();
    EXPECT_EQ(std::distance(fs::directory_iterator(folder), fs::directory_iterator()), 1)
        << "a temporary file is left";
}

} // namespace
} // namespace ovc
