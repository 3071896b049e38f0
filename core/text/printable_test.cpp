// SPDX-License-Identifier: Apache-2.0
#include "core/text/printable.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

using namespace std::string_literals;

TEST(Printable, WhatPrintsStaysAndWhatDoesNotIsSpelt) {
    const struct {
        std::string text, shown;
    } cases[] = {
        {"", ""},
        {"a b/c.ply ~'\"\\", "a b/c.ply ~'\"\\"},
        {"größe 模型 🐉.obj", "größe 模型 🐉.obj"},
        {"two\nlines\r\tand", "two\\nlines\\r\\tand"},
        {"\033[31mred\007\177\0"s, "\\x1b[31mred\\x07\\x7f\\x00"},
        {"\xc2\x9b"
         "31m",
         "\\u009b31m"}, // CSI in one character
        {"a\u202etxt.exe\u2066\u200f", "a\\u202etxt.exe\\u2066\\u200f"},
        {"\u2028\u2029", "\\u2028\\u2029"},
        {"gr\xf6\xdf"
         "e",
         "gr\\xf6\\xdfe"},                       // Latin-1
        {"\xc0\x80\xe0\x80\x80\xed\xa0\x80\xf5", // too long, a surrogate, beyond Unicode
         "\\xc0\\x80\\xe0\\x80\\x80\\xed\\xa0\\x80\\xf5"},
        {"\xe2\x82", "\\xe2\\x82"}, // cut
    };
    for (const auto& test : cases) {
        EXPECT_EQ(printable(test.text), test.shown);
        EXPECT_EQ(printable(test.shown), test.shown) << "twice";
    }
}

TEST(Printable, IsCutBetweenCharacters) {
    EXPECT_EQ(printable("abc", 3), "abc");
    EXPECT_EQ(printable("abcd", 3), "abc…");
    EXPECT_EQ(printable("aö", 2), "a…");
    EXPECT_EQ(printable("a\nb", 2), "a\\n…");
}

TEST(Printable, AnyBytesComeOutAsOneLineOfSoundText) {
    std::mt19937 random(1);
    for (int i = 0; i < 10000; ++i) {
        std::string text(random() % 20, '\0');
        for (char& c : text)
            c = char(random());
        const std::string shown = printable(text);
        for (const char c : shown)
            ASSERT_TRUE(static_cast<unsigned char>(c) >= 0x20 && c != 0x7f) << i;
        ASSERT_EQ(printable(shown), shown) << i;
    }
}

} // namespace
} // namespace ovc
