// SPDX-License-Identifier: Apache-2.0
// Tests Ctrl-C: the first one asks, the second one ends, and neither leaves half a file behind.
#include "host/terminal/interrupt.h"

#include "core/file/mapped_file.h"
#include "importers/file/output_file.h"
#include "tests/temp_folder.h"

#include <gtest/gtest.h>

#include <csignal>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>

namespace ovc {

namespace fs = std::filesystem;

class InterruptDeathTest : public testing::Test {
protected:
    void SetUp() override { testing::FLAGS_gtest_death_test_style = "fast"; }

    test::TempFolder folder_;
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

TEST_F(InterruptDeathTest, AClosedTerminalIsLikeOneUnlessItIsIgnored) {
    const auto close_terminal = [] {
        exit_on_interrupt();
        std::raise(SIGHUP);
    };
    EXPECT_EXIT(close_terminal(), testing::ExitedWithCode(kExitInterrupted),
                "overcast: interrupted\n");
    const auto close_under_nohup = [] {
        std::signal(SIGHUP, SIG_IGN);
        exit_on_interrupt();
        {
            const InterruptGuard guard;
            std::raise(SIGHUP);
            std::_Exit(guard.interrupted() ? 9 : 0);
        }
    };
    EXPECT_EXIT(close_under_nohup(), testing::ExitedWithCode(0), "^$");
}

TEST_F(InterruptDeathTest, AFileThatIsCutShortIsASentence) {
    const fs::path path = folder_ / "mapped";
    std::ofstream(path) << std::string(10000, 'x');
    const auto touch = [&] {
        exit_on_bus_error();
        const Result<MappedFile> file = MappedFile::open(path);
        fs::resize_file(path, 0);
        std::_Exit(file ? int(file->bytes()[9000]) : 9);
    };
    EXPECT_EXIT(touch(), testing::ExitedWithCode(kExitError),
                "a file that is in use was cut short");
}

} // namespace ovc
