// SPDX-License-Identifier: Apache-2.0
// Rates that clusters tell, compared with the page of all triangles.
#include "plugin/plan/page_rate.h"

#include "gpu/frame/frames.h"
#include "gpu/page/page.h"
#include "kdtree/partition.h"
#include "kdtree/sample.h"
#include "kdtree/test_soups.h"

#include <gtest/gtest.h>

#include <bit>

namespace ovc {
namespace {

double rate_of_one_page(const Soup& soup, const std::vector<TriangleId>& ids, const Box& bounds) {
    const Page page = build_page(soup, whole_leaf(soup, ids, bounds), nullptr, LoosePairs{true});
    return double(page.bytes() - kPageStart) / double(ids.size());
}

PageRates rates_of(const Soup& soup, const std::vector<TriangleId>& ids, uint32_t rate,
                   const Box& bounds) {
    const Cubes cubes = choose_cubes(soup, sample_triangles(soup, ids, rate), rate, ids.size());
    return PageRates(soup, ids, cubes, bounds, one_frame_suits(soup, ids, bounds));
}

TEST(PageRates, AreThoseOfTheWholePage) {
    const struct {
        std::string name;
        Soup soup;
        double least, most; // so that the test knows both ends of what pages take
    } cases[] = {{"closed grid", test::closed_grid(150), 40, 55},
                 {"strewn", test::random_soup(1, 40000, 0.01), 50, 85},
                 {"slivers", test::random_soup(2, 40000, 0.5), 50, 85}};
    for (const auto& [name, soup, least, most] : cases) {
        Box bounds;
        const auto ids = hittable_triangles(soup, nullptr, &bounds);
        const double whole = rate_of_one_page(soup, ids, bounds);
        EXPECT_GT(whole, least) << name;
        EXPECT_LT(whole, most) << name;
        for (const uint32_t rate : {1u, 4u}) {
            const PageRates rates = rates_of(soup, ids, rate, bounds);
            EXPECT_NEAR(rates.mean() * rates.with_cuts(40000, 1) / whole, 1, 0.08)
                << name << " by one in " << rate;
        }
    }
}

TEST(PageRates, CubesHoldWhatTheyAreMadeForHoweverFewAreDrawn) {
    const Soup soup = test::random_soup(3, 200'000, 0.005);
    const auto ids = hittable_triangles(soup, nullptr, nullptr);
    for (const uint32_t rate : {4u, 64u, 512u}) {
        const Cubes cubes = choose_cubes(soup, sample_triangles(soup, ids, rate), rate, ids.size());
        const CubeGrid grid(cubes.small);
        size_t inside = 0;
        for (const TriangleId id : ids)
            inside += size_t(std::popcount(grid.touched(soup.triangle(id))));
        EXPECT_GT(inside, cubes.small.size() * cubes.in_small / 4) << rate;
        EXPECT_LT(inside, cubes.small.size() * cubes.in_small * 4) << rate;
    }
}

TEST(PageRates, TellOnePartOfASceneFromAnother) {
    const Soup mesh = test::closed_grid(120), strewn = test::random_soup(1, 30000, 0.01);
    Soup both;
    for (const auto& [soup, x] : {std::pair(&mesh, 0.0), {&strewn, 10.0}}) {
        const auto corners = soup->chunks[0].corners();
        both.chunks.push_back(
            Chunk::owning(dvec3(x, 0, 0), std::vector<vec3>(corners.begin(), corners.end())));
    }
    Box bounds;
    const auto ids = hittable_triangles(both, nullptr, &bounds);
    const PageRates rates = rates_of(both, ids, 2, bounds);
    const double left = rates.within({dvec3(-5), dvec3(5)});
    const double right = rates.within({dvec3(5, -5, -5), dvec3(15, 5, 5)});
    EXPECT_LT(left, 50);
    EXPECT_GT(right, 51);
    EXPECT_GT(rates.mean(), left);
    EXPECT_LT(rates.mean(), right);
    const Box nowhere{dvec3(100), dvec3(101)};
    EXPECT_DOUBLE_EQ(rates.within(nowhere), rates.mean());
    EXPECT_GT(rates.worst_within(nowhere), right) << "it may be like the worst part";
    EXPECT_LT(rates.worst_within({dvec3(-5), dvec3(5)}), right);
}

} // namespace
} // namespace ovc
