// SPDX-License-Identifier: Apache-2.0
// Compares overcast diff with OpenImageIO's idiff, where that is installed, on rendered pictures:
// numbers and exit codes must be the same.
#include "tests/run_command.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>

namespace ovc {
namespace {

namespace fs = std::filesystem;

class DiffBesideIdiff : public testing::Test {
protected:
    void SetUp() override {
        if (test::run_shell("command -v idiff").exit_code != 0)
            GTEST_SKIP() << "idiff is not installed (Debian: openimageio-tools)";
        folder_ = fs::path(testing::TempDir()) / ("ovc_diff_" + std::to_string(getpid()));
        fs::create_directories(folder_);
        for (const char* words : {"-o a.png", "-o b.png --light 1,3,2"})
            ASSERT_EQ(
                run(std::string("overcast render box --quiet --size 64x48 ") + words).exit_code, 0);
    }
    void TearDown() override { fs::remove_all(folder_); }

    test::CommandResult run(const std::string& command) const {
        return test::run_shell("cd '" + folder_.string() +
                               "' && PATH=" OVC_BINARY_DIR "/bin:$PATH && " + command +
                               " 2>/dev/null");
    }

    fs::path folder_;
};

/// Returns the number_after after `key`.
double number_after(const std::string& text, const std::string& key) {
    const size_t at = text.find(key);
    EXPECT_NE(at, text.npos) << key << " in " << text;
    return at == text.npos ? -1 : std::stod(text.substr(at + key.size()));
}

TEST_F(DiffBesideIdiff, HasTheSameNumbers) {
    const std::string ours = run("overcast diff a.png b.png --json").output;
    const std::string theirs = run("idiff a.png b.png").output;
    EXPECT_GT(number_after(theirs, "Mean error = "), 0.01) << "the pictures differ";
    EXPECT_NEAR(number_after(ours, "\"mean\": "), number_after(theirs, "Mean error = "), 1e-6);
    EXPECT_NEAR(number_after(ours, "\"rmse\": "), number_after(theirs, "RMS error = "), 1e-6);
    EXPECT_NEAR(number_after(ours, "\"psnr\": "), number_after(theirs, "Peak SNR = "), 1e-3);
    EXPECT_NEAR(number_after(ours, "\"max\": "), number_after(theirs, "Max error  = "), 1e-6);
}

/// Leaves out warnings, hard limits and pictures of different sizes. For these, idiff 2.4.7 of
/// Debian 12 deviates from its documentation, which overcast diff follows.
TEST_F(DiffBesideIdiff, EndsWithTheSameCodes) {
    for (const char* words :
         {"a.png a.png", "a.png b.png", "a.png b.png -fail 0.9 -warn 0.9",
          "a.png b.png -fail 0.01 -failpercent 95 -warn 0.9",
          "a.png b.png -fail 0.01 -failpercent 20 -warn 0.9", "a.png none.png"}) {
        std::string with_two = words; // Our options begin with two minus signs.
        for (size_t at = 0; (at = with_two.find(" -", at)) != with_two.npos; at += 3)
            with_two.insert(at + 1, 1, '-');
        EXPECT_EQ(run("overcast diff " + with_two).exit_code,
                  run(std::string("idiff ") + words).exit_code)
            << words;
    }
}

} // namespace
} // namespace ovc
