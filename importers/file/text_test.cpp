// SPDX-License-Identifier: Apache-2.0
// Numbers are what the C library reads, to the last bit.
#include "importers/file/text.h"

#include "tests/random.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>
#include <cstdlib>

namespace ovc {
namespace {

void expect_as_the_c_library_reads(const std::string& word) {
    const auto single = parse_float(word);
    const auto full = parse_double(word);
    ASSERT_TRUE(single && full) << word;
    const float expected = std::strtof(word.c_str(), nullptr);
    const double exact = std::strtod(word.c_str(), nullptr);
    ASSERT_EQ(std::bit_cast<uint32_t>(*single), std::bit_cast<uint32_t>(expected)) << word;
    ASSERT_EQ(std::bit_cast<uint32_t>(float(*full)), std::bit_cast<uint32_t>(expected)) << word;
    // Only where the nearest double would be rounded to another float, its neighbour is taken.
    const double other = std::nextafter(exact, double(expected));
    ASSERT_EQ(std::bit_cast<uint64_t>(*full),
              std::bit_cast<uint64_t>(float(exact) == expected ? exact : other))
        << word;
}

TEST(Text, ReadsNumbersToTheLastBit) {
    test::Random random(7);
    for (int i = 0; i < 300'000; ++i) {
        std::string word = random.below(2) ? "-" : "";
        for (uint64_t n = 1 + random.below(10); n > 0; --n)
            word += char('0' + random.below(10));
        if (random.below(4) != 0) {
            word += '.';
            for (uint64_t n = 1 + random.below(12); n > 0; --n)
                word += char('0' + random.below(10));
        }
        expect_as_the_c_library_reads(word);
    }
}

TEST(Text, ReadsNumbersAtTheMiddleOfFloats) {
    for (const char* word :
         {"16777217", "-16777217", "16777217.0000001", "16777216.9999999", "16777219",
          "0.50000002980232238", "8388608.5", "8388609.5", "9007199254740993", "9007199254740992",
          "90071992547409.93", "99999999999999999", "123456789012345678901234567890"})
        expect_as_the_c_library_reads(word);
}

TEST(Text, ReadsNumbersOfOtherForms) {
    for (const char* word : {"0", "-0", "-0.0", "00012.50", "1.", ".5", "-.5", "1e10", "1E-3",
                             "-1.5e+3", "1e-40", "3.5e38", "1e-400", "inf", "-inf"})
        expect_as_the_c_library_reads(word);
    EXPECT_EQ(parse_float("+1.5"), 1.5f);
    EXPECT_TRUE(std::isnan(parse_float("nan").value()));
    for (const char* word :
         {"", "-", ".", "-.", "+-1", "1.5x", "1..5", "1.5.5", "0x10", "1,5", "e5"}) {
        EXPECT_FALSE(parse_float(word)) << word;
        EXPECT_FALSE(parse_double(word)) << word;
    }
}

TEST(Text, CountsBeforeAnOf) {
    EXPECT_EQ(counted(2, "light"), "2 lights");
    EXPECT_EQ(counted(1, "set of vertex colors"), "1 set of vertex colors");
    EXPECT_EQ(counted(2, "set of vertex colors"), "2 sets of vertex colors");
}

TEST(Text, UrisStandForNames) {
    EXPECT_EQ(decoded_uri("a%20b.png"), "a b.png");
    for (const char* plain : {"100%", "%2", "%zz.bin", "%00", ""})
        EXPECT_EQ(decoded_uri(plain), plain);
}

} // namespace
} // namespace ovc
