// SPDX-License-Identifier: Apache-2.0
// Which leaves are worth moving in: most rays a byte first, short queues later or never.
#include "plugin/two_level/waiting.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

Page page_of(uint64_t bytes) {
    Page page;
    page.texels.resize(bytes / sizeof(uvec4));
    return page;
}

std::vector<uint32_t> wanted(const std::vector<size_t>& counts, const std::vector<Page>& pages) {
    return worth_moving(counts, pages, kBytesARay);
}

TEST(WorthMoving, MostRaysAByteComeFirst) {
    const std::vector<Page> pages = {page_of(64 * kBytesARay), page_of(8 * kBytesARay),
                                     page_of(64 * kBytesARay)};
    EXPECT_EQ(wanted({600, 100, 700}, pages), (std::vector<uint32_t>{1, 2, 0}));
    EXPECT_EQ(wanted({0, 100, 0}, pages), (std::vector<uint32_t>{1}));
    EXPECT_EQ(wanted({99, 100, 101}, pages), (std::vector<uint32_t>{1, 2}))
        << "less than an eighth of the first: its queue may grow";
}

TEST(WorthMoving, NoPageIsMovedForRaysThatDoublesAnswerSooner) {
    const std::vector<Page> pages = {page_of(64 * kBytesARay), page_of(8 * kBytesARay)};
    EXPECT_EQ(wanted({63, 7}, pages), (std::vector<uint32_t>{}));
    EXPECT_EQ(wanted({64, 7}, pages), (std::vector<uint32_t>{0}));
    EXPECT_EQ(wanted({63, 8}, pages), (std::vector<uint32_t>{1}));
}

} // namespace
} // namespace ovc
