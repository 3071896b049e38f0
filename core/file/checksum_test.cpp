// SPDX-License-Identifier: Apache-2.0
#include "core/file/checksum.h"

#include <gtest/gtest.h>

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <random>
#include <vector>

namespace ovc {
namespace {

TEST(Checksum, IsThatOfXxhashForAnyLengthInAnyParts) {
    std::mt19937 random(1);
    for (size_t length = 0; length < 300; ++length) {
        std::vector<std::byte> bytes(length);
        std::ranges::generate(bytes, [&] { return std::byte(random()); });
        const uint64_t expected = XXH64(bytes.data(), length, 0);
        EXPECT_EQ(checksum_of(bytes), expected) << length;
        Checksum parts;
        for (std::span<const std::byte> rest(bytes); !rest.empty();) {
            const size_t part = std::min<size_t>(rest.size(), random() % 80);
            parts.add(rest.first(part));
            rest = rest.subspan(part);
        }
        EXPECT_EQ(parts.value(), expected) << length;
    }
}

TEST(Checksum, OfPartsMayBeAskedInBetween) {
    Checksum sum;
    EXPECT_EQ(sum.value(), 0xef46db3751d8e999u);
    sum.add_value(uint32_t(1));
    const uint64_t one = sum.value();
    sum.add_value(2.0);
    EXPECT_NE(sum.value(), one);
}

} // namespace
} // namespace ovc
