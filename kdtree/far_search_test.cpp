// SPDX-License-Identifier: Apache-2.0
// Few triangles that are far larger than all others are found, in whatever order they come.
#include "kdtree/far_search.h"

#include "kdtree/test_soups.h"

#include <gmock/gmock.h>

#include <algorithm>

namespace ovc {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

Box box_of_size(double size) {
    return {dvec3(-size / 2), dvec3(size / 2)};
}

TEST(FarSearch, FindsThoseThatReachBeyondAllOthers) {
    FarSearch search;
    search.add({0, 0}, box_of_size(1));
    EXPECT_THAT(search.found(), IsEmpty()) << "nothing else would be left";
    search.add({0, 1}, box_of_size(1000));
    search.add({0, 2}, box_of_size(7.9));
    EXPECT_THAT(search.found(), ElementsAre(TriangleId{0, 1}));
    search.add({1, 0}, box_of_size(100));
    EXPECT_THAT(search.found(), ElementsAre(TriangleId{0, 1}, TriangleId{1, 0}));
    // A triangle that lies apart makes the box of all others larger.
    search.add({2, 0}, {dvec3(49), dvec3(50)});
    EXPECT_THAT(search.found(), ElementsAre(TriangleId{0, 1}));
}

TEST(FarSearch, FindsNoMoreThanAFew) {
    FarSearch search;
    search.add({0, 0}, box_of_size(1));
    for (uint32_t i = 1; i <= FarSearch::kMax; ++i)
        search.add({0, i}, box_of_size(50));
    EXPECT_EQ(search.found().size(), FarSearch::kMax);
    search.add({1, 0}, box_of_size(50));
    EXPECT_THAT(search.found(), IsEmpty());
}

TEST(FarSearch, DoesNotDependOnTheOrder) {
    test::Random random(3);
    std::vector<std::pair<TriangleId, Box>> all;
    for (uint32_t i = 0; i < 200; ++i)
        all.push_back({{0, i}, box_of_size(i % 20 == 3 ? 100 : random(0, 5))});
    std::vector<TriangleId> expected;
    for (int turn = 0; turn < 20; ++turn) {
        FarSearch first, second;
        for (size_t i = 0; i < all.size(); ++i)
            (random.below(2) ? first : second).add(all[i].first, all[i].second);
        first.add(second);
        if (turn == 0)
            expected = first.found();
        EXPECT_EQ(first.found(), expected);
        for (size_t i = all.size() - 1; i > 0; --i)
            std::swap(all[i], all[random.below(uint32_t(i + 1))]);
    }
    EXPECT_EQ(expected.size(), 10u);
}

} // namespace
} // namespace ovc
