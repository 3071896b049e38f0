// SPDX-License-Identifier: Apache-2.0
// Tests the line on a pseudo-terminal of 20 columns: what it writes, and that it does not flicker.
#include "host/terminal/terminal_line.h"

#include <gtest/gtest.h>
#include <pty.h>
#include <unistd.h>

namespace ovc {
namespace {

/// Sends standard error to a pseudo-terminal while it lives.
class Terminal {
public:
    Terminal() {
        winsize size{};
        size.ws_col = 20;
        size.ws_row = 5;
        if (openpty(&ours_, &theirs_, nullptr, nullptr, &size) != 0)
            return;
        before_ = dup(STDERR_FILENO);
        dup2(theirs_, STDERR_FILENO);
    }
    ~Terminal() {
        if (before_ < 0)
            return;
        dup2(before_, STDERR_FILENO);
        for (const int descriptor : {before_, ours_, theirs_})
            close(descriptor);
    }
    bool is_there() const { return before_ >= 0; }
    /// Writes a mark, and returns everything that was written before it.
    std::string read_up_to_mark() const {
        [[maybe_unused]] const ssize_t written = write(STDERR_FILENO, "#", 1);
        std::string text;
        for (char c; read(ours_, &c, 1) == 1 && c != '#';)
            text += c;
        return text;
    }

private:
    int ours_ = -1, theirs_ = -1, before_ = -1;
};

TEST(TerminalLine, OverwritesItselfIsCutAndSaysNothingTwice) {
    const Terminal terminal;
    if (!terminal.is_there())
        GTEST_SKIP() << "no pseudo-terminal";
    {
        TerminalLine line;
        ASSERT_TRUE(line.shown());
        line.show("50 % done");
        EXPECT_EQ(terminal.read_up_to_mark(), "\r50 % done\033[K");
        line.show("50 % done");
        EXPECT_EQ(terminal.read_up_to_mark(), "");
        line.show("1234567890123456789012345");
        EXPECT_EQ(terminal.read_up_to_mark(), "\r1234567890123456789\033[K");
    }
    EXPECT_EQ(terminal.read_up_to_mark(), "\r\033[K") << "gone at the end";
    TerminalLine quiet(/* wanted= */ false);
    quiet.show("never seen");
    EXPECT_EQ(terminal.read_up_to_mark(), "");
}

TEST(TimeLeft, IsAsPreciseAsAnEstimate) {
    EXPECT_EQ(time_left(3.2), "4 s left");
    EXPECT_EQ(time_left(41), "45 s left");
    EXPECT_EQ(time_left(601), "11 min left");
    EXPECT_EQ(time_left(10000), "3 h left");
}

} // namespace
} // namespace ovc
