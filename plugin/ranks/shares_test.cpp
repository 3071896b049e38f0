// SPDX-License-Identifier: Apache-2.0
// Boxes that rays come into, the stops of rays, and shares of about the same size.
#include "plugin/ranks/shares.h"

#include "kdtree/test_soups.h"
#include "plugin/ranks/box_entry.h"
#include "plugin/ranks/stops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>

namespace ovc {
namespace {

/// A ray that goes through a point of a box comes into it before that point, however thin the box
/// and far the origin.
TEST(BoxEntry, IsNotBehindAnyPointOfTheBox) {
    test::Random random(1);
    for (int i = 0; i < 200'000; ++i) {
        const double size = std::exp2(random(-40, 40));
        Box box;
        box.add(random.point(-1, 1) * size);
        box.add(random.point(-1, 1) * size);
        if (i % 3 == 0)
            box.hi[i / 3 % 3] = box.lo[i / 3 % 3];
        Ray ray;
        ray.dir = random.point(-1, 1) * std::exp2(random(-20, 20));
        if (i % 5 == 0)
            ray.dir[i / 5 % 3] = i % 2 ? 0 : 1e-310;
        // The box becomes one around a point that lies on the ray as doubles have it.
        const double t = random(0, 100);
        ray.org = random.point(-1, 1) * size * std::exp2(random(0, 20));
        box.add(ray.at(t));
        const Box around =
            box.padded(4 * box.rounding() + 0x1p-50 * max_component(glm::abs(ray.org)));
        EXPECT_LE(box_entry(ray, around), t) << i;
    }
}

TEST(BoxEntry, KnowsBoxesThatARayMisses) {
    const Box box{dvec3(-1), dvec3(1)};
    EXPECT_EQ(box_entry({{0, 0, -5}, 0, {0, 0, 1}, 10}, box) < 4.0001, true);
    EXPECT_EQ(box_entry({{0, 0, -5}, 0, {0, 0, -1}, 10}, box), kNoEntry);
    EXPECT_EQ(box_entry({{2, 0, -5}, 0, {0, 0, 1}, 10}, box), kNoEntry);
    EXPECT_EQ(box_entry({{0, 0, -5}, 0, {0, 0, 1}, 3}, box), kNoEntry);
    EXPECT_EQ(box_entry({{0, 0, -5}, 7, {0, 0, 1}, 30}, box), kNoEntry);
    EXPECT_DOUBLE_EQ(box_entry({{0, 0, 0}, 0.5, {0, 0, 1}, 30}, box), 0.5);
}

/// 1 / dir.y is infinite, and yet the ray gets there.
TEST(BoxEntry, IsThereForARayWithHardlyAnyDirection) {
    const Box box{dvec3(0, 1e-11, -1), dvec3(2, 1, 1)};
    EXPECT_LE(box_entry({{-1, 0, 0}, 0, {1e-300, 1e-310, 0}}, box), 1.5e300);
    EXPECT_EQ(box_entry({{-1, 0, 2}, 0, {1e-300, 1e-310, 0}}, box), kNoEntry);
}

TEST(StopFinder, FindsEveryRankOfTheBoxesOnTheWay) {
    test::Random random(2);
    std::vector<PageBox> boxes;
    std::vector<uint32_t> owners;
    constexpr uint32_t kRanks = 7;
    for (uint32_t page = 0; page < 1500; ++page) {
        const dvec3 at = random.point(-1, 1);
        boxes.push_back({{at, at + random.point(0, 0.1)}, page});
        owners.push_back(page % 50 ? uint32_t(random.below(kRanks)) : kEveryRank);
    }
    const StopFinder finder(boxes, owners, /* here= */ 3);
    std::vector<Stop> stops;
    for (int i = 0; i < 2000; ++i) {
        Ray ray{random.point(-2, 2), 0, random.point(-1, 1)};
        if (i % 4 == 0)
            ray.dir[i / 4 % 3] = i % 8 ? 0.0 : -0.0;
        finder.find(ray, stops);
        std::vector<double> first(kRanks, kNoEntry);
        for (const PageBox& box : boxes) {
            const uint32_t rank = owners[box.page] == kEveryRank ? 3 : owners[box.page];
            first[rank] = std::min(first[rank], box_entry(ray, box.box));
        }
        for (uint32_t rank = 0; rank < kRanks; ++rank) {
            const auto found = std::ranges::find(stops, rank, &Stop::rank);
            if (first[rank] == kNoEntry)
                continue; // a part around several boxes may be met where they are not
            ASSERT_NE(found, stops.end());
            EXPECT_LE(found->t, first[rank] * (1 + 1e-15) + 1e-300);
        }
        EXPECT_TRUE(std::ranges::is_sorted(stops, {}, &Stop::t));
        for (const Stop& stop : stops)
            EXPECT_EQ(std::ranges::count(stops, stop.rank, &Stop::rank), 1);
    }
}

TEST(StopFinder, KnowsNoStopsWhereThereAreNoPages) {
    std::vector<Stop> stops(3);
    StopFinder({}, {}, 0).find(Ray(), stops);
    EXPECT_TRUE(stops.empty());
}

} // namespace
} // namespace ovc
