// SPDX-License-Identifier: Apache-2.0
// Linked pages, walked on the CPU from their top, offer every triangle of every leaf that a ray
// hits; a frame in which triangles are too small for float32 is told.
#include "gpu/linked.h"

#include "gpu/answers.h"
#include "gpu/node_boxes.h"
#include "gpu/page_walk.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

namespace ovc {
namespace {

struct Built {
    std::vector<TriangleId> triangles;
    Level1 level1;
    std::vector<Page> pages;
};

Built build(const Soup& soup, size_t leaves, bool shared) {
    Built built;
    Box bounds;
    built.triangles = hittable_triangles(soup, nullptr, &bounds);
    built.level1 = partition(soup, built.triangles, bounds,
                             uint32_t(std::max<size_t>(built.triangles.size() / leaves, 1)));
    if (shared)
        share_frame(built.level1);
    const Numbering numbers(soup);
    for (const Leaf& leaf : built.level1.leaves)
        built.pages.push_back(build_page(soup, numbers, leaf));
    return built;
}

/// What the pool holds, as one page: its root is that of the top.
Page pool_of(const Built& built, const LinkedPages& linked) {
    Page pool;
    const auto put = [&](const Page& page, uint32_t first_unit, uint32_t owner) {
        EXPECT_EQ(pool.units(), first_unit);
        const size_t begin = pool.texels.size();
        pool.texels.resize(begin + page.texels.size());
        copy_relocated(page, first_unit, std::span(pool.texels).subspan(begin), owner);
    };
    for (uint32_t i = 0; i < built.pages.size(); ++i)
        put(built.pages[i], linked.first_unit[i], i + 1);
    if (built.pages.size() > 1)
        put(linked.top, linked.top_unit, 0);
    const uint32_t root = pool.texels[size_t(linked.top_unit) * OVC_UNIT_TEXELS + 2].x;
    for (size_t i = 0; i < OVC_UNIT_TEXELS; ++i)
        pool.texels[OVC_ROOT_UNIT * OVC_UNIT_TEXELS + i] =
            pool.texels[size_t(root) * OVC_UNIT_TEXELS + i];
    return pool;
}

class Linked : public testing::TestWithParam<size_t> {};
INSTANTIATE_TEST_SUITE_P(Leaves, Linked, testing::Values(1, 2, 9, 60));

TEST_P(Linked, WalkedFromTheTopFindsWhatBruteForceFinds) {
    for (const auto& [name, soup] : test::unpleasant_soups()) {
        const Built built = build(soup, GetParam(), /* shared= */ true);
        if (built.pages.empty())
            continue;
        const auto linked = link_pages(built.level1, built.pages, 1u << 30);
        ASSERT_TRUE(linked) << name;
        const Page pool = pool_of(built, *linked);
        const Leaf scene = scene_leaf(built.level1.bounds);
        const Numbering numbers(soup);
        for (const Ray& ray : test::unpleasant_rays(soup, 78, 400)) {
            if (!ray.valid())
                continue;
            const PreparedRay p(ray);
            Nearest nearest(p);
            walk_page(
                pool, scene, p, p.ray.t_min,
                [&](uint32_t number) {
                    const TriangleId id = numbers.id(number);
                    nearest.offer(soup.triangle(id), id);
                    return false;
                },
                [&] { return nearest.limit(); });
            const Hit expected = test::brute_force(soup, built.triangles, ray);
            ASSERT_TRUE(test::same(expected, nearest.hit()))
                << name << ": " << test::describe(expected) << " but found "
                << test::describe(nearest.hit());
        }
    }
}

TEST_P(Linked, TakeNoMoreThanTold) {
    const Soup soup = test::closed_grid(24);
    const Built built = build(soup, GetParam(), /* shared= */ true);
    uint64_t bytes = 0;
    for (const Page& page : built.pages)
        bytes += page.bytes();
    const uint64_t most = most_linked_bytes(bytes, built.pages.size());
    EXPECT_TRUE(link_pages(built.level1, built.pages, most));
    EXPECT_FALSE(link_pages(built.level1, built.pages, bytes - 1)) << "not all pages fit";
}

constexpr uint64_t kRoom = 1 << 28;

/// A link holds the box of its page's root and leads nowhere, and there is one for each page.
TEST_P(Linked, TheTreeHasALinkForEachPage) {
    const Built built = build(test::closed_grid(24), GetParam(), /* shared= */ true);
    const auto tree = make_link_tree(built.level1, built.pages, kRoom);
    ASSERT_TRUE(tree);
    ASSERT_EQ(tree->link_unit.size(), built.pages.size());
    std::vector<uint32_t> units = tree->link_unit;
    std::sort(units.begin(), units.end());
    EXPECT_EQ(std::unique(units.begin(), units.end()), units.end());
    for (uint32_t leaf = 0; leaf < built.pages.size(); ++leaf) {
        const auto link = tree->top.view().subspan(size_t(tree->link_unit[leaf]) * OVC_UNIT_TEXELS);
        EXPECT_EQ(link[3], uvec4(OVC_LEADS_NOWHERE, leaf + 1, 0, 0));
        for (size_t axis = 0; axis < 3; ++axis) {
            const uvec4 root = built.pages[leaf].view()[OVC_ROOT_UNIT * OVC_UNIT_TEXELS + axis];
            const GridRange range = range_of(link[axis], 0);
            for (size_t child = 0; child < 4; ++child) {
                EXPECT_LE(range.lo, range_of(root, child).lo);
                EXPECT_GE(range.hi, range_of(root, child).hi);
            }
            EXPECT_TRUE(range_of(link[axis], 1).empty()) << "a second child";
        }
    }
}

TEST(LinkedPages, NeedRoomForThePageBesideTheTree) {
    const Built built = build(test::closed_grid(24), 9, /* shared= */ true);
    uint64_t largest = 0;
    for (const Page& page : built.pages)
        largest = std::max(largest, page.bytes());
    const uint64_t top = make_link_tree(built.level1, built.pages, kRoom)->top.bytes();
    EXPECT_TRUE(make_link_tree(built.level1, built.pages, top + largest));
    EXPECT_FALSE(make_link_tree(built.level1, built.pages, top + largest - 1));
}

TEST(LinkedPages, AreNoMoreThanAKeyCanName) {
    const Built built = build(test::closed_grid(4), 9, /* shared= */ true);
    std::vector<Page> pages(OVC_KEY_LEAF - 1, built.pages[0]);
    const auto tree = make_link_tree(built.level1, pages, kRoom);
    ASSERT_TRUE(tree);
    const uint32_t last = tree->link_unit.back();
    EXPECT_EQ(leaf_of(tree->top.view()[size_t(last) * OVC_UNIT_TEXELS + 3].y), pages.size() - 1);
    pages.push_back(built.pages[0]);
    EXPECT_FALSE(make_link_tree(built.level1, pages, kRoom));
}

TEST(LinkedPages, NeedAFrameThatAllLeavesShare) {
    const Built built = build(test::closed_grid(24), 9, /* shared= */ false);
    EXPECT_FALSE(link_pages(built.level1, built.pages, 1u << 30));
    EXPECT_FALSE(make_link_tree(built.level1, built.pages, kRoom));
}

double share_of(const Soup& soup) {
    Box bounds;
    const auto triangles = hittable_triangles(soup, nullptr, &bounds);
    return doubtful_share(soup, triangles, scene_leaf(bounds).frame);
}

TEST(DoubtfulShare, GrowsAsTrianglesShrinkInTheFrame) {
    const double coarse = share_of(test::closed_grid(16));
    EXPECT_GT(coarse, 0);
    EXPECT_NEAR(share_of(test::closed_grid(32)) / coarse, 2, 0.2);

    EXPECT_LT(share_of(test::closed_grid(32)), kMostDoubtful);
    EXPECT_GT(share_of(test::random_soup(3, 1000, 1e-7)), kMostDoubtful);
}

Soup together(Soup soup, Soup more) {
    soup.chunks.push_back(std::move(more.chunks.front()));
    return soup;
}

TEST(DoubtfulShare, LeavesSmallTrianglesToLargeOnesBesideThem) {
    const auto small = [] { return test::random_soup(3, 3000, 1e-5); };
    const double alone = share_of(small());
    EXPECT_GT(alone, 0.01);
    EXPECT_LT(share_of(together(small(), test::random_soup(4, 3000, 0.1))), alone / 100)
        << "rays seldom hit the small ones";
}

TEST(DoubtfulShare, ATriangleThatReachesFarDoesNotHideThoseInOneSpot) {
    Soup ground = test::one_chunk({{-1e6, -1e6, 0}, {1e6, -1e6, 0}, {0, 1e6, 0}});
    EXPECT_GT(share_of(together(test::closed_grid(32), std::move(ground))), kMostDoubtful);
}

} // namespace
} // namespace ovc
