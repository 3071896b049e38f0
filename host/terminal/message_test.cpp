// SPDX-License-Identifier: Apache-2.0
// Tests which line breaks and control characters of a message reach standard error.
#include "host/terminal/message.h"

#include <gtest/gtest.h>

#include <string>

namespace ovc {
namespace {

std::string printed(std::string_view message) {
    testing::internal::CaptureStderr();
    print_message(message);
    return testing::internal::GetCapturedStderr();
}

TEST(Message, ShowsTheLineOfASceneInALineOfItsOwn) {
    EXPECT_EQ(printed("a.pov:2:1: found 'b'\n    b\n    ^"),
              "overcast: a.pov:2:1: found 'b'\n    b\n    ^\n");
}

TEST(Message, LetsNoControlCharacterThrough) {
    EXPECT_EQ(printed("there is no file 'a\novercast: b'"),
              "overcast: there is no file 'a\\novercast: b'\n");
    EXPECT_EQ(printed("bad \x1b[31m\n    red \x1b[0m\r"),
              "overcast: bad \\x1b[31m\n    red \\x1b[0m\\r\n");
    EXPECT_EQ(printed(""), "overcast: \n");
}

} // namespace
} // namespace ovc
