// SPDX-License-Identifier: Apache-2.0
#include "plugin/hosts/tachyon/duplicate_sets.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace ovc::tachyon {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(DuplicateSets, SmallestHasAllOthersInAnyOrderOfCorners) {
    const std::vector<double> corners = {
        9, 9, 9, 1, 0, 0, 0,    1, 0, //
        0, 0, 0, 1, 0, 0, 0,    1, 0, // the smallest of a set of three
        1, 0, 0, 0, 1, 0, 0,    0, 0, // turned
        0, 0, 0, 1, 0, 0, 0,    1, 1, // almost
        0, 1, 0, 1, 0, 0, -0.0, 0, 0, // wound the other way, and a negative zero
        9, 9, 9, 0, 1, 0, 1,    0, 0,
    };
    for (const DuplicateSets& duplicates :
         {DuplicateSets(corners),
          DuplicateSets(std::vector<float>(corners.begin(), corners.end()))}) {
        EXPECT_THAT(duplicates.of(0), ElementsAre(5));
        EXPECT_THAT(duplicates.of(1), ElementsAre(2, 4));
        EXPECT_THAT(duplicates.of(2), IsEmpty());
        EXPECT_THAT(duplicates.of(3), IsEmpty());
        EXPECT_EQ(duplicates.smallest(5), 0u);
        EXPECT_EQ(duplicates.smallest(4), 1u);
        EXPECT_EQ(duplicates.smallest(1), 1u);
        EXPECT_EQ(duplicates.smallest(3), 3u);
    }
}

TEST(DuplicateSets, NoTrianglesHaveNoDuplicates) {
    EXPECT_THAT(DuplicateSets().of(0), IsEmpty());
    EXPECT_THAT(DuplicateSets(std::vector<float>{}).of(0), IsEmpty());
}

} // namespace
} // namespace ovc::tachyon
