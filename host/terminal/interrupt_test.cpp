// SPDX-License-Identifier: Apache-2.0
// Tests Ctrl-C: the first one asks, the second one ends, and neither leaves half a file behind.
#include "host/terminal/interrupt.h"

#include "importers/file/output_file.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>

namespace ovc {

namespace fs = std::filesystem;

class InterruptDeathTest : public testing::Test {
protected:
    void SetUp() override {
        testing::FLAGS_gtest_death_test_style = "fast";
        std::string name = fs::temp_directory_path() / "overcast_interrupt_XXXXXX";
        ASSERT_NE(mkdtemp(name.data()), nullptr);
        folder_ = name;
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path folder_;
};

TEST_F(InterruptDeathTest, TheFirstOnlyAsks) {
    testing::internal::CaptureStderr();
    {
        const InterruptGuard guard;
        EXPECT_FALSE(guard.interrupted());
        std::raise(SIGINT);
        EXPECT_TRUE(guard.interrupted());
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "overcast: interrupted; finishing this batch and saving (press again to give up)\n");
    std::signal(SIGINT, SIG_DFL);
}

TEST_F(InterruptDeathTest, IsRememberedByTheGuardAround) {
    testing::internal::CaptureStderr();
    {
        const InterruptGuard around("ending");
        {
            const InterruptGuard inner("stopping");
            std::raise(SIGINT);
        }
        EXPECT_TRUE(around.interrupted());
        const InterruptGuard next("stopping again");
        EXPECT_TRUE(next.interrupted());
    }
    EXPECT_EQ(testing::internal::GetCapturedStderr(),
              "overcast: interrupted; stopping (press again to give up)\n");
    EXPECT_FALSE(InterruptGuard().interrupted());
    std::signal(SIGINT, SIG_DFL);
}

TEST_F(InterruptDeathTest, TheSecondRemovesWhatIsUnfinished) {
    const fs::path inside = folder_ / "inside";
    fs::create_directory(inside);
    const auto press_twice = [&] {
        const InterruptGuard guard;
        std::raise(SIGINT);
        const Result<OutputFile> file = OutputFile::create(inside / "a.png");
        if (!file || fs::is_empty(inside))
            std::_Exit(9);
        std::raise(SIGINT);
    };
    EXPECT_EXIT(press_twice(), testing::ExitedWithCode(kExitInterrupted),
                "press again to give up\\)\novercast: interrupted\n");
    EXPECT_TRUE(fs::is_empty(inside));
}

} // namespace ovc
