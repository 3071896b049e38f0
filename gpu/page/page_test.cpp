// SPDX-License-Identifier: Apache-2.0
// A page, walked on the CPU, offers every triangle that a ray hits; and it is as small as promised.
#include "gpu/page/page.h"

#include "core/system/parallel.h"
#include "gpu/page/node_boxes.h"
#include "gpu/page/page_check.h"
#include "gpu/page/test_walk.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

Level1 one_leaf(const Soup& soup) {
    Box bounds;
    const auto ids = hittable_triangles(soup, nullptr, &bounds);
    return partition(soup, ids, bounds, 1u << 30);
}

/// Returns rods across the axes, two triangles each. One in 20 is long, and planes cut these.
Soup rods(size_t count) {
    test::Random random(17);
    std::vector<vec3> corners;
    for (size_t i = 0; i < count; ++i) {
        const vec3 from(random.point(-1, 1));
        const vec3 along = (i % 20 ? 0.02f : 1.0f) * vec3(random.point(-1, 1));
        const vec3 across = 0.005f * vec3(random.point(-1, 1));
        for (const vec3& corner : {from, from + along, from + across, from + along, from + across,
                                   from + along + across})
            corners.push_back(corner);
    }
    Soup soup;
    soup.chunks.push_back(Chunk::owning(dvec3(0), std::move(corners)));
    return soup;
}

uint64_t pairs_of(const Page& page) {
    uint64_t pairs = 0;
    for (uint64_t unit = OVC_ROOT_UNIT; unit < page.units(); ++unit)
        pairs += page.texels[unit * OVC_UNIT_TEXELS + 3].w == OVC_PAIR;
    return pairs;
}

Page loosened(const Soup& soup) {
    return build_page(soup, Numbering(soup), one_leaf(soup).leaves[0], nullptr, LoosePairs{true});
}

TEST(Page, HoldsTwoSliversInAUnit) {
    const Soup soup = test::random_soup(3, 20000, 0.02);
    const Page page = loosened(soup);
    EXPECT_TRUE(page.has_loose_pairs());
    EXPECT_TRUE(is_walkable(page, uint32_t(soup.triangle_count())));
    EXPECT_LE(double(page.bytes()), 80.0 * double(soup.triangle_count()));
}

TEST(Page, HoldsNoLoosePairsWhereMostPairUp) {
    const Soup mesh = test::closed_grid(64);
    const Level1 level1 = one_leaf(mesh);
    const Page page = loosened(mesh);
    EXPECT_FALSE(page.has_loose_pairs());
    EXPECT_EQ(page.texels, build_page(mesh, Numbering(mesh), level1.leaves[0]).texels);
}

TEST(Page, IsNotWalkableWhereItsHeaderHidesLoosePairs) {
    const Soup soup = test::random_soup(3, 2000, 0.02);
    Page page = loosened(soup);
    page.texels[OVC_LOOSE_TEXEL].x = 0;
    EXPECT_FALSE(is_walkable(page, uint32_t(soup.triangle_count())));
}

TEST(Page, HoldsWhatPlanesCutInEachPart) {
    constexpr size_t kRods = 4000;
    const Soup soup = rods(kRods);
    const Level1 level1 = one_leaf(soup);
    const Page page = build_page(soup, Numbering(soup), level1.leaves[0]);
    EXPECT_GT(pairs_of(page), kRods * 102 / 100);
    EXPECT_LE(pairs_of(page), kRods * 110 / 100);
    EXPECT_TRUE(is_walkable(page, uint32_t(soup.triangle_count())));
}

TEST(Page, WalkedInDoubleFindsWhatBruteForceFinds) {
    auto soups = test::unpleasant_soups();
    soups.push_back({"rods", rods(3000)});
    for (const auto& [name, soup] : soups) {
        const Level1 level1 = one_leaf(soup);
        if (level1.leaves.empty())
            continue;
        ASSERT_EQ(level1.leaves.size(), 1u);
        const Leaf& leaf = level1.leaves[0];
        const Page page = build_page(soup, Numbering(soup), leaf, nullptr, LoosePairs{true});
        const auto rays = test::unpleasant_rays(soup, 77, 800);
        ASSERT_NO_FATAL_FAILURE(test::expect_brute_force(name, soup, page, leaf, rays));
    }
}

TEST(Page, TakesAtMost52BytesATriangleWhereMostPairUpAnd96InASoup) {
    const Soup mesh = test::closed_grid(128);
    const Level1 of_mesh = one_leaf(mesh);
    EXPECT_LE(double(build_page(mesh, Numbering(mesh), of_mesh.leaves[0]).bytes()),
              52.0 * double(mesh.triangle_count()));
    const Soup soup = test::random_soup(3, 20000, 0.02);
    const Level1 of_soup = one_leaf(soup);
    EXPECT_LE(double(build_page(soup, Numbering(soup), of_soup.leaves[0]).bytes()),
              96.0 * double(soup.triangle_count()));
}

TEST(Page, HasTheSameBitsOnAnyNumberOfThreads) {
    const Soup mesh = test::closed_grid(256); // several blocks of pairs, and a tree in parallel
    const Soup soup = test::random_soup(3, 20000, 0.02);
    const Soup cut = rods(4000);
    for (const Soup* each : {&mesh, &soup, &cut}) {
        const Page page = loosened(*each);
        for (const size_t threads : {1, 2, 5}) {
            const ThreadLimit limit(threads);
            const Page again = loosened(*each);
            EXPECT_EQ(page.texels, again.texels) << threads;
            EXPECT_EQ(page.depth, again.depth) << threads;
        }
    }
}

TEST(Page, NeedsFewStackWordsEvenWhereNothingCanBeSplit) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const Level1 level1 = one_leaf(soup);
        if (level1.leaves.empty())
            continue;
        EXPECT_LE(build_page(soup, Numbering(soup), level1.leaves[0]).depth, 24u) << name;
    }
}

/// Returns the number of inner nodes on the longest way from `unit` down, counted from the texels
/// alone.
uint32_t longest_way(const Page& page, uint32_t unit) {
    const auto texel = [&](int i) {
        return page.texels[size_t(unit) * OVC_UNIT_TEXELS + size_t(i)];
    };
    if (texel(3).w == OVC_PAIR)
        return 0;
    uint32_t longest = 0;
    for (uint32_t child = 0; child < 4; ++child) {
        if (!range_of(texel(0), child).empty())
            longest = std::max(longest, longest_way(page, texel(3).x + child));
    }
    return 1 + longest;
}

TEST(Page, SaysHowManyWordsItsLongestWayCanPush) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const Level1 level1 = one_leaf(soup);
        if (level1.leaves.empty())
            continue;
        const Page page = build_page(soup, Numbering(soup), level1.leaves[0]);
        EXPECT_EQ(page.depth, longest_way(page, OVC_ROOT_UNIT)) << name;
    }
}

} // namespace
} // namespace ovc
