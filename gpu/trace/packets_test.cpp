// SPDX-License-Identifier: Apache-2.0
#include "gpu/trace/packets.h"

#include "gpu/trace/answers.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <map>

namespace ovc {
namespace {

LocalRay toward(const dvec3& dir) {
    return {vec3(0), 1, vec3(dir), OVC_SKIPS_NONE};
}

TEST(Packets, NeighboursThatGoTheSameWayAreCoherent) {
    test::Random random(9);
    std::vector<LocalRay> fan(1000), scattered(1000);
    for (size_t i = 0; i < fan.size(); ++i) {
        fan[i] = toward({double(i) / 1000, 0, 1});
        scattered[i] = toward(random.point(-1, 1));
    }
    EXPECT_TRUE(coherent(fan));
    EXPECT_FALSE(coherent(scattered));
    for (size_t i = 0; i < fan.size(); ++i)
        fan[i].org = vec3(random.point(-1, 1));
    EXPECT_FALSE(coherent(fan)) << "the same way, from anywhere";
    for (LocalRay& ray : scattered)
        ray.t_end = OVC_NO_RAY;
    EXPECT_TRUE(coherent(scattered)) << "none at all";
    EXPECT_TRUE(coherent(std::span<const LocalRay>()));
}

/// Returns rays of which every third goes to the other side, every fifth goes farthest along
/// another axis, and some are OVC_NO_RAY.
PagedVector<LocalRay> two_sided(size_t rays) {
    PagedVector<LocalRay> slots(whole_blocks(rays), {vec3(0), OVC_NO_RAY, vec3(1), 0});
    for (size_t i = 0; i < rays; ++i) {
        const double side = i % 3 == 0 ? -0.1 : 0.1;
        slots[i] = toward(i % 5 == 0 ? dvec3(side, -1, 0.9) : dvec3(side, -0.9, 1));
        slots[i].asks = uint32_t(i);
        slots[i].t_end = i % 7 == 0 ? OVC_NO_RAY : 1;
    }
    return slots;
}

TEST(Packets, GoAlikeAndLoseNoRay) {
    for (const size_t rays : {1, 2, 999, 1000, 4096, 100001}) {
        const PagedVector<LocalRay> before = two_sided(rays);
        PagedVector<LocalRay> slots = before;
        const auto parted = part_packets(slots, rays, 4 * before.size());
        ASSERT_TRUE(parted);
        EXPECT_EQ(parted->empty(), rays < 5);
        EXPECT_EQ(slots.size(), whole_blocks(slots.size()));
        for (size_t i = 0; i < slots.size(); i += 2)
            if (slots[i].t_end >= 0 && slots[i + 1].t_end >= 0) {
                ASSERT_EQ(slots[i].dir.x < 0, slots[i + 1].dir.x < 0) << i;
                ASSERT_EQ(slots[i].dir.z == 1, slots[i + 1].dir.z == 1) << i;
            }
        std::map<uint32_t, uint32_t> slot_of;
        for (const auto& [ray, slot] : *parted) {
            EXPECT_TRUE(slot_of.emplace(ray, slot).second);
            EXPECT_GE(slot, rays);
        }
        for (uint32_t ray = 0; ray < rays; ++ray) {
            const uint32_t slot = slot_of.contains(ray) ? slot_of[ray] : ray;
            ASSERT_EQ(slots[slot].asks, ray);
            ASSERT_EQ(slots[slot].t_end, before[ray].t_end);
            if (slot != ray) {
                ASSERT_EQ(slots[ray].t_end, OVC_NO_RAY);
            }
        }
    }
}

TEST(Packets, StayAsTheyAreWhereTheRestFindsNoRoom) {
    const PagedVector<LocalRay> before = two_sided(8192);
    PagedVector<LocalRay> slots = before;
    EXPECT_FALSE(part_packets(slots, 8192, 8192));
    EXPECT_FALSE(part_packets(slots, 8192, 8192 + 256));
    ASSERT_EQ(slots.size(), before.size());
    for (size_t i = 0; i < slots.size(); ++i)
        ASSERT_EQ(slots[i].t_end, before[i].t_end);

    PagedVector<LocalRay> few(8192, toward({0.1, 0.1, 1}));
    for (const size_t i : {1, 101, 201})
        few[i].dir.x = -0.1f;
    const auto parted = part_packets(few, 8192, 8192);
    ASSERT_TRUE(parted) << "doubles decide a few";
    EXPECT_TRUE(parted->empty());
    EXPECT_EQ(few[101].t_end, 1);
}

TEST(Packets, OfRaysThatWaitedKeepTheirLinks) {
    PagedVector<ResumedRay> slots(256);
    for (size_t i = 0; i < slots.size(); ++i)
        slots[i] = {toward({i == 11 ? -1.0 : 1.0, 0, 0}), uint32_t(i), {}};
    const auto parted = part_packets(slots, 20, 512);
    ASSERT_TRUE(parted);
    ASSERT_EQ(parted->size(), 1u);
    EXPECT_EQ(slots[parted->front().slot].waited_for, 11u);
}

} // namespace
} // namespace ovc
