// SPDX-License-Identifier: Apache-2.0
// Saved levels come back as they were, and those of other soups or options do not. No damage is
// passed over, and damage behind right checksums leads no walk astray.
#include "plugin/build/saved_levels.h"

#include "core/file/test_archive.h"
#include "kdtree/test_soups.h"
#include "plugin/build/restored_levels.h"
#include "plugin/build/same_levels_test.h"
#include "tests/fuzz/levels.h"

#include <gtest/gtest.h>

#include <random>

namespace ovc {
namespace {

using test::ArchiveMemory;
using test::expect_same;

constexpr LeafLimits kLimits{60, 1 << 20};
const auto kSameLimits = [](uint64_t, uint64_t) { return kLimits; };

ArchiveMemory saved(const BuiltScene& scene) {
    ArchiveMemory memory;
    EXPECT_TRUE(save_levels(scene, memory.sink()));
    return memory;
}

TEST(SavedLevels, ComeBackAsTheyWere) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        SCOPED_TRACE(name);
        const BuiltScene built = build_for_test(soup, kLimits);
        const ArchiveMemory memory = saved(built);
        const auto found = restore_levels(memory.bytes(), soup, kSameLimits);
        ASSERT_TRUE(found) << found.error().message;
        ASSERT_TRUE(*found);
        expect_same(built, **found);
    }
}

TEST(SavedLevels, OfAnotherSoupOrOtherLimitsAreNotTaken) {
    const Soup soup = test::random_soup(2, 300, 0.1);
    const ArchiveMemory memory = saved(build_for_test(soup, kLimits));
    const auto taken = [&](const Soup& other, const LeafLimits& limits) {
        const auto found =
            restore_levels(memory.bytes(), other, [&](uint64_t, uint64_t) { return limits; });
        EXPECT_TRUE(found) << found.error().message;
        return found && *found;
    };
    EXPECT_TRUE(taken(soup, kLimits));
    EXPECT_TRUE(taken(soup, {60, 1 << 21})) << "pages of 60 triangles come near neither limit";
    EXPECT_FALSE(taken(soup, {61, 1 << 20}));
    EXPECT_FALSE(taken(soup, {60, 4096}));

    std::vector<vec3> corners(soup.chunks[0].corners().begin(), soup.chunks[0].corners().end());
    const auto with_corners = [&](dvec3 origin) {
        Soup other;
        other.chunks.push_back(Chunk::owning(origin, corners));
        return other;
    };
    EXPECT_TRUE(taken(with_corners(soup.chunks[0].origin()), kLimits));
    EXPECT_FALSE(taken(with_corners(soup.chunks[0].origin() + dvec3(1, 0, 0)), kLimits));
    corners[100].x = std::nextafter(corners[100].x, 1.0f);
    EXPECT_FALSE(taken(with_corners(soup.chunks[0].origin()), kLimits));
}

TEST(SavedLevels, TheSameMeshesCutOtherwiseAreAnotherSoup) {
    const Soup soup = test::random_soup(2, 300, 0.1);
    const std::span<const vec3> corners = soup.chunks[0].corners();
    Soup halves;
    halves.chunks.push_back(Chunk::borrowing(soup.chunks[0].origin(), corners.first(300)));
    halves.chunks.push_back(Chunk::borrowing(soup.chunks[0].origin(), corners.subspan(300)));
    const ArchiveMemory memory = saved(build_for_test(soup, kLimits));
    const auto found = restore_levels(memory.bytes(), halves, kSameLimits);
    ASSERT_TRUE(found);
    EXPECT_FALSE(*found);
}

TEST(SavedLevels, WhatIsNoneOfThemIsRefusedWithAReason) {
    const Soup soup = test::random_soup(2, 10, 0.1);
    const auto message = [&](Bytes bytes) {
        const auto found = restore_levels(bytes, soup, kSameLimits);
        return found ? std::string() : found.error().message;
    };
    const ArchiveMemory memory = saved(build_for_test(soup, kLimits));
    EXPECT_EQ(message({}), "is too short to be whole");
    EXPECT_EQ(message(memory.bytes().subspan(1)), "is not aligned to 64 bytes");
    EXPECT_EQ(message(memory.bytes().first(memory.size() - 64)), "is cut off");
    ArchiveMemory other(memory.bytes());
    other.data()[0] = std::byte('x');
    EXPECT_EQ(message(other.bytes()), "does not begin as ovc levels does");
}

TEST(SavedLevels, NoChangedByteIsTaken) {
    const Soup soup = test::random_soup(3, 100, 0.1);
    const BuiltScene built = build_for_test(soup, kLimits);
    ArchiveMemory memory = saved(built);
    for (size_t i = 0; i < memory.size(); ++i) {
        memory.data()[i] ^= std::byte(0x10);
        const auto found = restore_levels(memory.bytes(), soup, kSameLimits);
        if (found && *found)
            expect_same(built, **found); // the byte lies between parts
        memory.data()[i] ^= std::byte(0x10);
    }
}

/// The fuzzer does the same for longer.
TEST(SavedLevels, DamageBehindRightChecksumsIsRefusedOrHarmless) {
    for (uint32_t seed = 0; seed < 4000; ++seed) {
        std::mt19937 random(seed);
        std::vector<uint8_t> orders(1 + 6 * (1 + random() % 4) + (random() % 16 == 0));
        for (uint8_t& byte : orders)
            byte = uint8_t(random());
        fuzz_levels(orders.data(), orders.size());
    }
}

} // namespace
} // namespace ovc
