// SPDX-License-Identifier: Apache-2.0
#include "plugin/hosts/tachyon/settings.h"

#include <gtest/gtest.h>

namespace ovc::tachyon {
namespace {

TEST(TachyonSettings, BytesHaveUnits) {
    EXPECT_EQ(bytes_of("17"), 17u);
    EXPECT_EQ(bytes_of("3K"), 3072u);
    EXPECT_EQ(bytes_of("256M"), 268435456u);
    EXPECT_EQ(bytes_of("2G"), 2147483648u);
    EXPECT_EQ(bytes_of("18446744073709551615"), UINT64_MAX);
}

TEST(TachyonSettings, WhatIsNoSizeIsNotTaken) {
    for (const char* text : {"", "0", "0M", "-1", "+1", " 1", "M", "1T", "1MB", "1 M", "1.5G",
                             "18446744073709551616", "18014398509481984K", "99999999999G"})
        EXPECT_FALSE(bytes_of(text)) << text;
}

} // namespace
} // namespace ovc::tachyon
