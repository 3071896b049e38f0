// SPDX-License-Identifier: Apache-2.0
// Tests which texts are memory sizes, and which are refused.
#include "host/arguments/memory_size.h"

#include <gtest/gtest.h>

namespace ovc {

TEST(MemorySize, ReadsBytesAndUnits) {
    const struct {
        const char* text;
        uint64_t bytes;
    } cases[] = {{"1", 1},
                 {"268435456", 268435456},
                 {"1K", 1024},
                 {"256M", 256ull << 20},
                 {"256MiB", 256ull << 20},
                 {"256mib", 256ull << 20},
                 {"256MB", 256000000},
                 {"1.5G", 3ull << 29},
                 {"2T", 2ull << 40},
                 {"12 MiB", 12ull << 20},
                 {"640 bytes", 640},
                 {"1.9", 1},
                 {"4000G", 4000ull << 30}};
    for (const auto& c : cases) {
        const Result<MemorySize> size = parse_memory_size(c.text);
        ASSERT_TRUE(size) << c.text;
        EXPECT_EQ(size->bytes, c.bytes) << c.text;
        EXPECT_EQ(size->of(1000), c.bytes) << c.text;
    }
}

TEST(MemorySize, ReadsSharesOfTheDevice) {
    const Result<MemorySize> half = parse_memory_size("50%");
    ASSERT_TRUE(half);
    EXPECT_EQ(half->of(1ull << 30), 1ull << 29);
    EXPECT_EQ(parse_memory_size("12.5 %")->of(800), 100u);
}

TEST(MemorySize, RefusesTheRest) {
    for (const char* text : {"abc", "", "-1", "-5M", "M", "12X", "12MM", "12MiBs", "nan", "inf",
                             "50%%", "1e999", "0x10"})
        EXPECT_FALSE(parse_memory_size(text)) << text;
    EXPECT_EQ(parse_memory_size("abc").error().message,
              "'abc' is no memory size; write bytes (268435456), 256M, 1.5GiB or 50%");
    EXPECT_EQ(parse_memory_size("0K").error().message,
              "the memory size '0K' is zero; it must be more");
    EXPECT_EQ(parse_memory_size("101%").error().message,
              "'101%' is more memory than the device has; 100% is the most");
    EXPECT_EQ(parse_memory_size("9999T").error().message,
              "'9999T' is more memory than any device has");
    for (const char* text : {"0.1", "0.0001K", "1e-30%", "1e-307%"})
        EXPECT_EQ(parse_memory_size(text).error().message,
                  "the memory size '" + std::string(text) + "' is less than one byte");
    EXPECT_EQ(parse_memory_size("0x10").error().message,
              "'0x10' is hexadecimal; a memory size is decimal");
}

TEST(HumanBytes, UsesTheUnitThatKeepsTheNumberShort) {
    EXPECT_EQ(human_bytes(0), "0 bytes");
    EXPECT_EQ(human_bytes(1), "1 byte");
    EXPECT_EQ(human_bytes(1023), "1023 bytes");
    EXPECT_EQ(human_bytes(1024), "1.0 KiB");
    EXPECT_EQ(human_bytes(12ull << 20), "12.0 MiB");
    EXPECT_EQ(human_bytes((1ull << 30) - 1), "1.0 GiB");
}

TEST(HumanCount, GroupsDigits) {
    EXPECT_EQ(human_count(0), "0");
    EXPECT_EQ(human_count(999), "999");
    EXPECT_EQ(human_count(871414), "871,414");
    EXPECT_EQ(human_count(1234567890), "1,234,567,890");
}

} // namespace ovc
