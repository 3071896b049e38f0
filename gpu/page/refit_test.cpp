// SPDX-License-Identifier: Apache-2.0
// A refitted page, walked on the CPU, offers every triangle that a ray hits where it is now, but
// for those that it says it has lost.
#include "gpu/page/refit.h"

#include "gpu/page/page_check.h"
#include "gpu/page/test_walk.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace ovc {
namespace {

/// One leaf over a soup, and its page. Triangles move within its box.
struct OnePage {
    explicit OnePage(Soup made) : soup(std::move(made)), numbers(soup) {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        leaf = whole_leaf(soup, ids, bounds);
        middle = vec3(bounds.center());
        page = build_page(soup, numbers, leaf);
    }

    /// Moves a triangle's corners anywhere within the leaf's box.
    void scatter(uint32_t prim) {
        std::vector<vec3> corners;
        for (size_t k = 0; k < 3; ++k)
            corners.push_back(vec3(glm::mix(leaf.box.lo, leaf.box.hi, random.point(0, 1))));
        soup.chunks[0].set_corners(prim, corners);
    }

    /// Moves all corners towards the middle; those in one place stay together.
    void wave() {
        const std::span<const vec3> before = soup.chunks[0].corners();
        std::vector<vec3> corners(before.begin(), before.end());
        for (vec3& corner : corners)
            corner = middle + (corner - middle) * (0.9f + 0.1f * std::sin(20 * corner.x));
        soup.chunks[0].set_corners(0, corners);
    }

    /// Refits the page; those that it loses are the leaf's no more.
    std::optional<RefitCost> refit(const NumberSet* moved) {
        std::vector<uint32_t> parted;
        const auto cost = refit_page(page, soup, numbers, leaf, moved, parted);
        for (const uint32_t number : parted)
            std::erase(leaf.triangles, numbers.id(number));
        return cost;
    }

    void expect_brute_force() {
        ASSERT_TRUE(is_walkable(page, uint32_t(soup.triangle_count())));
        test::expect_brute_force("refitted", soup, page, leaf, test::unpleasant_rays(soup, 5, 600));
    }

    test::Random random{11};
    Soup soup;
    Numbering numbers;
    Leaf leaf;
    vec3 middle;
    Page page;
};

class Refit : public testing::TestWithParam<test::NamedSoup (*)()> {};

test::NamedSoup grid() {
    return {"grid", test::closed_grid(24)};
}
test::NamedSoup random_triangles() {
    return {"random", test::random_soup(4, 3000, 0.05)};
}

TEST_P(Refit, OfWhatHasNotMovedChangesNothing) {
    OnePage one(GetParam()().soup);
    const Texels before = one.page.texels;
    const NumberSet none(one.numbers.count());
    for (const NumberSet* moved : {&none, (const NumberSet*)nullptr}) {
        const auto cost = one.refit(moved);
        ASSERT_TRUE(cost);
        EXPECT_NEAR(cost->before, cost->after, 1e-9 * cost->before);
        EXPECT_EQ(one.page.texels, before);
    }
}

TEST_P(Refit, FollowsAllTriangles) {
    OnePage one(GetParam()().soup);
    for (int round = 0; round < 3; ++round) {
        one.wave();
        ASSERT_TRUE(one.refit(nullptr));
        one.expect_brute_force();
    }
}

TEST_P(Refit, FollowsSomeTrianglesFarAway) {
    OnePage one(GetParam()().soup);
    for (int round = 0; round < 3; ++round) {
        NumberSet moved(one.numbers.count());
        for (uint32_t prim = uint32_t(round); prim < one.numbers.count(); prim += 100) {
            one.scatter(prim);
            moved.add(prim);
        }
        const size_t before = one.leaf.triangles.size();
        const auto cost = one.refit(&moved);
        ASSERT_TRUE(cost);
        EXPECT_GT(cost->after, cost->before) << "boxes have become larger";
        EXPECT_GT(one.leaf.triangles.size(), before * 95 / 100);
        one.expect_brute_force();
    }
}

TEST_P(Refit, RenumbersTrianglesAlone) {
    constexpr uint32_t kAdded = 1000;
    OnePage one(GetParam()().soup);
    const uint32_t count = uint32_t(one.soup.triangle_count());
    const Page before = one.page;
    renumber(one.page, kAdded);
    EXPECT_TRUE(is_walkable(one.page, count, kAdded));
    EXPECT_FALSE(is_walkable(one.page, count, kAdded + 1));
    EXPECT_FALSE(is_walkable(one.page, count - 1, kAdded));
    EXPECT_EQ(one.page.texels, build_page(one.soup, Numbering(one.soup, kAdded), one.leaf).texels);
    renumber(one.page, uint32_t(0) - kAdded);
    EXPECT_EQ(one.page.texels, before.texels);
}

INSTANTIATE_TEST_SUITE_P(Soups, Refit, testing::Values(grid, random_triangles),
                         [](const auto& named) { return named.param().name; });

} // namespace
} // namespace ovc
