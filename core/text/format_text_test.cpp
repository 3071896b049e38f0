// SPDX-License-Identifier: Apache-2.0
#include "core/text/format_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace ovc {
namespace {

TEST(FormatText, PutsEachArgumentInItsPlace) {
    EXPECT_EQ(format_text("no place"), "no place");
    EXPECT_EQ(format_text("{}", "all of it"), "all of it");
    EXPECT_EQ(format_text("{} of {} bytes, {}", 1, std::string("two"), std::string_view("three")),
              "1 of two bytes, three");
    EXPECT_EQ(format_text("{}{}", "{}", "b"), "{}b"); // a value is no pattern
}

TEST(FormatText, WritesNumbersInDecimal) {
    EXPECT_EQ(format_text("{} {}", std::numeric_limits<uint64_t>::max(), int8_t(-3)),
              "18446744073709551615 -3");
    EXPECT_EQ(format_text("{} {}", true, false), "1 0");
    EXPECT_EQ(format_text("{} {} {}", 0.1, -2.5e300, 3.0), "0.1 -2.5e+300 3");
    EXPECT_EQ(format_text("{}", std::numeric_limits<double>::infinity()), "inf");
}

TEST(FormatText, HexadecimalHasZerosInFront) {
    EXPECT_EQ(hexadecimal(0, 4), "0000");
    EXPECT_EQ(hexadecimal(0xbeef, 2), "beef");
    EXPECT_EQ(hexadecimal(~uint64_t(0), 16), "ffffffffffffffff");
}

} // namespace
} // namespace ovc
