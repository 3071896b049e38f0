// SPDX-License-Identifier: Apache-2.0
// Tests programs that end by themselves and programs that are made to end.
#include "host/bench/programs/run_program.h"

#include <gmock/gmock.h>

namespace ovc {
namespace {

constexpr double kLong = 60;

Result<ProgramEnd> shell(const std::string& script, double limit = kLong,
                         const std::function<bool()>& stop = {}) {
    return watch_program(std::vector<std::string>{"sh", "-c", script}, limit, stop);
}

TEST(RunProgram, SaysHowAProgramEnded) {
    const Result<ProgramEnd> end = shell("echo first >&2; echo the reason >&2; echo out; exit 3");
    ASSERT_TRUE(end);
    EXPECT_EQ(end->exit_code, 3);
    EXPECT_EQ(end->said, "the reason");
    EXPECT_FALSE(end->stopped);
    EXPECT_FALSE(end->too_long);
    EXPECT_EQ(shell("kill -TERM $$")->exit_code, -1);
    EXPECT_EQ(shell("echo 'a.pov:1:5: found b' >&2; echo '    b' >&2; echo '    ^' >&2")->said,
              "a.pov:1:5: found b");
}

TEST(RunProgram, EndsWhatIsToStop) {
    int looks = 0;
    const Result<ProgramEnd> end = shell("exec sleep 50", kLong, [&] { return ++looks > 2; });
    ASSERT_TRUE(end);
    EXPECT_TRUE(end->stopped);
    EXPECT_LT(end->seconds, 40);
    EXPECT_EQ(end->exit_code, -1);
}

TEST(RunProgram, EndsWhatTakesTooLong) {
    const Result<ProgramEnd> end = shell("exec sleep 50", 0.2);
    ASSERT_TRUE(end);
    EXPECT_TRUE(end->too_long);
    EXPECT_FALSE(end->stopped);
    EXPECT_LT(end->seconds, 40);
}

TEST(RunProgram, LetsAProgramEndInItsOwnWayWhenAsked) {
    const Result<ProgramEnd> end =
        shell("trap 'echo tidied >&2; exit 2' INT; while :; do sleep 0.05; done", 0.3);
    ASSERT_TRUE(end);
    EXPECT_EQ(end->exit_code, 2);
    EXPECT_EQ(end->said, "tidied");
}

TEST(RunProgram, NamesWhatCannotBeStarted) {
    const Result<ProgramEnd> end =
        watch_program(std::vector<std::string>{"no-such-program"}, kLong, {});
    ASSERT_FALSE(end);
    EXPECT_THAT(end.error().message, testing::HasSubstr("no-such-program cannot be started"));
}

} // namespace
} // namespace ovc
