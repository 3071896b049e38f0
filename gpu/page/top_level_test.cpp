// SPDX-License-Identifier: Apache-2.0
// The top-level tree, walked on the CPU, offers every triangle of every leaf that a ray hits, both
// if pages are apart and if they lie in a pool.
#include "gpu/page/top_level.h"

#include "gpu/page/test_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

namespace ovc {
namespace {

struct Built {
    std::vector<TriangleId> triangles;
    Level1 level1;
    std::vector<Page> pages;
    TopLevel top;
};

/// in_one_frame: if false, each leaf keeps its own frame, behind a portal.
Built build(const Soup& soup, size_t leaves, size_t links_per_page, bool in_one_frame = true) {
    Built built;
    Box bounds;
    built.triangles = hittable_triangles(soup, nullptr, &bounds);
    built.level1 = partition(soup, built.triangles, bounds,
                             uint32_t(std::max<size_t>(built.triangles.size() / leaves, 1)));
    if (in_one_frame)
        share_frame(built.level1);
    const Numbering numbers(soup);
    for (const Leaf& leaf : built.level1.leaves)
        built.pages.push_back(build_page(soup, numbers, leaf));
    built.top = build_top_level(built.level1, built.pages, links_per_page * built.pages.size());
    return built;
}

/// Returns the contents of a pool in which all pages are resident, as one page.
Page pool_of(const Built& built) {
    Page pool = built.top.tree;
    for (uint32_t page = 0; page < built.pages.size(); ++page) {
        const auto first_unit = uint32_t(pool.units());
        pool.texels.resize(pool.texels.size() + built.pages[page].texels.size());
        copy_relocated(built.pages[page].view(), first_unit,
                       std::span(pool.texels).subspan(size_t(first_unit) * OVC_UNIT_TEXELS));
        for (const Link& link : built.top.links_of(page))
            pool.texels[size_t(link.unit) * OVC_UNIT_TEXELS + 3].x = first_unit + link.first_child;
    }
    return pool;
}

/// The parameters are the number of leaves, and of links a page.
class TopLevelTree : public testing::TestWithParam<std::tuple<size_t, size_t>> {};
INSTANTIATE_TEST_SUITE_P(LeavesAndLinks, TopLevelTree,
                         testing::Combine(testing::Values(1, 2, 9, 60), testing::Values(1, 4, 90)));

TEST_P(TopLevelTree, HoldsWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const auto [leaves, links] = GetParam();
        const Built built = build(soup, leaves, links);
        if (built.pages.empty())
            continue;
        const Page pool = pool_of(built);
        const Leaf scene = scene_leaf(built.level1.bounds);
        for (const Ray& ray : test::unpleasant_rays(soup, 78, 200)) {
            if (!ray.valid())
                continue;
            const PreparedRay p(ray);
            const Hit expected = test::brute_force(soup, built.triangles, ray);
            for (const Hit& found : {test::nearest_in_pages(soup, built.top, built.pages, scene, p),
                                     test::nearest_in_page(soup, pool, scene, p)})
                ASSERT_TRUE(test::same(expected, found))
                    << name << ": " << test::describe(expected);
        }
    }
}

TEST_P(TopLevelTree, LeadsThroughPortalsToWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const auto [leaves, links] = GetParam();
        const Built built = build(soup, leaves, links, /* in_one_frame= */ false);
        if (built.pages.empty())
            continue;
        const size_t parts = built.pages.size(); // at most: leaves in one place share a frame
        EXPECT_LE(built.top.portals.size(), 1 + parts);
        EXPECT_LE(built.top.tree.bytes(),
                  max_top_level_bytes(links * parts) + parts * (kMaxBytesPerPart - kPortalBytes));
        const Leaf scene = scene_leaf(built.level1.bounds);
        for (const Ray& ray : test::unpleasant_rays(soup, 79, 200)) {
            if (!ray.valid())
                continue;
            const Hit found =
                test::nearest_in_pages(soup, built.top, built.pages, scene, PreparedRay(ray));
            const Hit expected = test::brute_force(soup, built.triangles, ray);
            ASSERT_TRUE(test::same(expected, found)) << name << ": " << test::describe(expected);
        }
    }
}

TEST_P(TopLevelTree, HasLinksThatLeadNowhere) {
    const auto [leaves, links] = GetParam();
    const Built built = build(test::closed_grid(24), leaves, links);
    const auto unit_of = [](const Page& page, uint32_t unit) {
        return page.view().subspan(size_t(unit) * OVC_UNIT_TEXELS, OVC_UNIT_TEXELS);
    };
    EXPECT_LE(built.top.tree.bytes(), max_top_level_bytes(links * built.pages.size()));
    std::vector<uint32_t> units;
    for (uint32_t page = 0; page < built.pages.size(); ++page)
        for (const Link& link : built.top.links_of(page)) {
            const auto unit = unit_of(built.top.tree, link.unit);
            EXPECT_EQ(unit[3], uvec4(OVC_LEADS_NOWHERE, page + 1, link.first_child, 0));
            EXPECT_LT(link.first_child, built.pages[page].units());
            units.push_back(link.unit);
        }
    std::ranges::sort(units);
    EXPECT_EQ(std::ranges::adjacent_find(units), units.end());
    EXPECT_LE(units.size(), std::max(links, size_t(1)) * built.pages.size());
    const size_t pages = built.pages.size();
    const bool opened = links > 1 && pages > 1;
    EXPECT_EQ(units.size() == pages, !opened);
    // Nine or more pages are so small that 90 links each hold all their pairs.
    EXPECT_EQ(units.empty(), links == 90 && leaves >= 9);
}

TEST(TopLevelTree, OpensPagesOnlyWhereAllAreResident) {
    constexpr uint64_t kPages = 10, kBytes = 1 << 20;
    const uint64_t enough = kBytes + max_top_level_bytes(kLinksPerPage * kPages);
    EXPECT_EQ(max_links(kPages, kBytes, enough), kLinksPerPage * kPages);
    EXPECT_EQ(max_links(kPages, kBytes, enough - 1), kPages);
    EXPECT_EQ(max_links(1, kBytes, 1 << 30), 1u);
}

} // namespace
} // namespace ovc
