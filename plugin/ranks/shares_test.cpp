// SPDX-License-Identifier: Apache-2.0
// Boxes that rays come into, the stops of rays, and shares of about the same size.
#include "plugin/ranks/shares.h"

#include "kdtree/test_soups.h"
#include "plugin/build/build_scene.h"
#include "plugin/fallback/exact_fallback.h"
#include "plugin/ranks/box_entry.h"
#include "plugin/ranks/stops.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>
#include <map>
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

/// Returns neighbours, rays from all over, or some that run along an axis, and at times an invalid
/// one.
std::vector<Ray> packet_of_rays(test::Random& random, int kind) {
    const Ray middle{random.point(-2, 2), 0, random.point(-1, 1)};
    std::vector<Ray> rays(1 + random.below(StopFinder::kPacket), middle);
    for (Ray& ray : rays) {
        ray.org += random.point(-1, 1) * (kind % 4 ? 0.01 : 1.0);
        ray.dir += random.point(-1, 1) * (kind % 4 ? 0.01 : 1.0);
        if (kind % 8 == 1)
            ray.dir[kind / 8 % 3] = random.below(2) ? 0.0 : -0.0;
        if (kind % 8 == 2)
            ray.t_max = random(0, 2);
        if (kind % 64 == 3 && random.below(8) == 0)
            ray.org.x = std::numeric_limits<double>::quiet_NaN();
    }
    return rays;
}

TEST(StopFinder, FindsEveryRankOfTheBoxesOnTheWay) {
    test::Random random(2);
    constexpr uint32_t kRanks = 7, kHere = 3;
    for (const int spread : {1, 50}) { // ranks have pages all over, or in a corner each
        std::vector<OwnedBox> boxes;
        for (uint32_t i = 0; i < 700; ++i) {
            const double corner = spread == 1 ? 0 : double(i % kRanks);
            const dvec3 at = random.point(-1, 1) / double(spread) + corner / kRanks;
            boxes.push_back({{at, at + random.point(0, 0.1) / double(spread)},
                             i % 50 ? uint32_t(random.below(kRanks)) : kEveryRank});
        }
        const StopFinder finder(boxes, kHere);
        for (int i = 0; i < 300; ++i) {
            const std::vector<Ray> rays = packet_of_rays(random, i);
            std::vector<Stop> all;
            std::vector<uint32_t> ends(rays.size());
            finder.find(rays, all, ends);
            for (size_t j = 0; j < rays.size(); ++j) {
                const auto stops =
                    std::span(all).subspan(j ? ends[j - 1] : 0, ends[j] - (j ? ends[j - 1] : 0));
                if (!rays[j].valid()) {
                    ASSERT_EQ(stops.size(), 1u);
                    EXPECT_EQ(stops[0].rank, kHere);
                    continue;
                }
                std::vector<double> first(kRanks, kNoEntry);
                for (const OwnedBox& box : boxes) {
                    double& min = first[box.owner == kEveryRank ? kHere : box.owner];
                    min = std::min(min, box_entry(rays[j], box.box));
                }
                for (uint32_t rank = 0; rank < kRanks; ++rank) {
                    EXPECT_LE(std::ranges::count(stops, rank, &Stop::rank), 1);
                    if (first[rank] == kNoEntry)
                        continue; // its packet was found to come by this rank alone
                    const auto found = std::ranges::find(stops, rank, &Stop::rank);
                    ASSERT_NE(found, stops.end());
                    EXPECT_LE(found->t, first[rank] * (1 + 1e-15) + 1e-300);
                }
                EXPECT_TRUE(std::ranges::is_sorted(stops, {}, &Stop::t));
            }
        }
    }
}

/// Where all boxes that a packet comes by are of this rank, or none are, no ray is looked at alone.
TEST(StopFinder, LeavesOutRanksThatAPacketDoesNotComeBy) {
    const std::vector<OwnedBox> boxes = {{{dvec3(0), dvec3(1)}, 0}, {{dvec3(5), dvec3(6)}, 1}};
    const StopFinder finder(boxes, /* here= */ 0);
    std::vector<Stop> stops;
    std::vector<uint32_t> ends(2);
    const std::vector<Ray> to_0 = {{{0.2, 0.2, -3}, 0, {0, 0, 1}}, {{0.3, 0.2, -3}, 0, {0, 0, 1}}};
    finder.find(to_0, stops, ends);
    ASSERT_EQ(stops.size(), 2u);
    EXPECT_EQ(stops[0].rank, 0u);
    EXPECT_LE(stops[0].t, 3);
    const std::vector<Ray> away = {{{0.2, 0.2, -3}, 0, {0, 0, -1}},
                                   {{0.3, 0.2, -3}, 0, {0, 0, -1}}};
    finder.find(away, stops, ends);
    EXPECT_EQ(stops.size(), 2u);
    EXPECT_EQ(finder.first_owner(to_0[0]), 0u);
    EXPECT_EQ(finder.first_owner({{5.5, 5.5, 0}, 0, {0, 0, 1}}), 1u);
    EXPECT_EQ(finder.first_owner(away[0]), kNone);
}

/// Expects that rays come into a box of a rank that has the triangle they hit, before they do.
/// Returns how many hit any.
int expect_boxes_around_hits(const BuiltScene& scene, std::span<const uint32_t> owners,
                             const std::map<uint32_t, std::vector<Box>>& boxes,
                             test::Random& random) {
    const Box& around = scene.level1.bounds;
    const double size = max_component(around.extent());
    int hits = 0;
    for (int i = 0; i < 300; ++i) {
        const dvec3 to = around.center() + random.point(-0.5, 0.5) * around.extent();
        Ray ray;
        ray.org = to + random.point(-1, 1) * size;
        ray.dir = to - ray.org;
        const Hit hit = trace_exactly<false>(scene, PreparedRay(ray));
        if (!hit.is_hit())
            continue;
        double entry = kNoEntry;
        for (size_t page = 0; page < owners.size(); ++page)
            if (std::ranges::binary_search(scene.level1.leaves[page].list(), hit.id))
                for (const Box& box : boxes.at(owners[page]))
                    entry = std::min(entry, box_entry(ray, box));
        EXPECT_LE(entry, hit.t);
        ++hits;
    }
    return hits;
}

/// With several pages a box, a box a page, and many boxes in each page.
TEST(OwnedBoxes, LieAroundEveryHit) {
    TwoLevelOptions options;
    options.leaves = 20;
    const MemoryPlan room{.pool_bytes = uint64_t(1) << 30, .buffer_bytes = uint64_t(1) << 30};
    test::Random random(3);
    int hits = 0;
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const Result<BuiltScene> scene = build_scene(soup, options, room, {}, nullptr);
        ASSERT_TRUE(scene) << scene.error().message;
        std::vector<uint32_t> owners;
        for (uint32_t page = 0; page < scene->pages.size(); ++page)
            owners.push_back(page % 5 ? page % 3 : kEveryRank);
        for (const size_t max : {2, 7, 500}) {
            std::map<uint32_t, std::vector<Box>> boxes;
            for (const OwnedBox& box : owned_boxes(*scene, owners, max))
                boxes[box.owner].push_back(box.box);
            for (const auto& [owner, all] : boxes)
                EXPECT_LE(all.size(), max);
            hits += expect_boxes_around_hits(*scene, owners, boxes, random);
        }
    }
    EXPECT_GT(hits, 1000);
}

TEST(StopFinder, KnowsNoStopsWhereThereAreNoPages) {
    std::vector<Stop> stops;
    std::vector<uint32_t> ends(1, 7);
    const Ray ray;
    StopFinder({}, 0).find({&ray, 1}, stops, ends);
    EXPECT_TRUE(stops.empty());
    EXPECT_EQ(ends[0], 0u);
}

} // namespace
} // namespace ovc
